/// Runs long work for Python on a separate thread without the interpreter's lock, while the calling thread handles
/// signals (Ctrl-C) and polls a callback that may stop the work.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <future>
#include <optional>

#include "dismantle/run_context.h"

namespace dismantle::python {

namespace py = pybind11;

/// What to do after the first Ctrl-C, once the work has ended.
enum class OnInterrupt {
  raise,         ///< raise KeyboardInterrupt
  keep_results,  ///< return the partial results; a second Ctrl-C raises
};

/// Call it with the interpreter's lock. Returns the result of `work`. Throws the exception of `work`, of a signal
/// handler or of `should_stop` (None, or a callable without arguments). `work` must end soon when `cancel` is set.
template <class Work>
auto run_interruptible(const CancelToken& cancel, const py::object& should_stop, OnInterrupt on_interrupt, Work work,
                       bool* interrupted = nullptr) {
  auto result = std::async(std::launch::async, std::move(work));
  std::optional<py::error_already_set> raised;
  int interrupts = 0;
  while (true) {
    {
      py::gil_scoped_release release;
      if (result.wait_for(std::chrono::milliseconds(20)) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      raised.emplace();
      cancel.cancel();
      const bool first = interrupts++ == 0;
      if (first && on_interrupt == OnInterrupt::keep_results && raised->matches(PyExc_KeyboardInterrupt)) {
        raised.reset();
        if (interrupted != nullptr) *interrupted = true;
      }
    }
    if (!raised && !cancel.cancelled() && !should_stop.is_none()) {
      try {
        if (py::cast<bool>(py::bool_(should_stop()))) cancel.cancel();
      } catch (py::error_already_set& error) {
        raised.emplace(error);
        cancel.cancel();
      }
    }
  }
  if (raised) {
    try {
      result.get();
    } catch (const std::exception&) {  // caused by cancellation; the reason for the cancellation is thrown instead
    }
    throw py::error_already_set(*raised);
  }
  return result.get();
}

}  // namespace dismantle::python
