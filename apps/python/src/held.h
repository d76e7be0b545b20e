/// Python objects that are owned by C++ threads.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <new>
#include <string>

namespace dismantle::python {

namespace py = pybind11;

/// Shared ownership that can be copied and released without the interpreter's lock. If it is released after the end of
/// the interpreter, the object is leaked.
using Held = std::shared_ptr<py::object>;

/// Call it with the interpreter's lock.
inline Held hold(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            if (Py_IsInitialized() == 0) return;
            py::gil_scoped_acquire lock;
            delete held;
          }};
}

/// The exception with its traceback, as Python prints it. Call it with the interpreter's lock. A process that has a
/// handler for memory that runs out (a trial of bench()) is ended by it, as where C++ runs out of memory.
inline std::string traceback_of(const py::error_already_set& error) {
  if (error.matches(PyExc_MemoryError))
    if (const std::new_handler handler = std::get_new_handler(); handler != nullptr) handler();
  const py::object lines =
      py::module_::import("traceback").attr("format_exception")(error.type(), error.value(), error.trace());
  std::string text = py::cast<std::string>(py::str("").attr("join")(lines));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace dismantle::python
