/// A parallel loop that reports its progress and stops when it is told to.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>

#include "dismantle/errors.h"
#include "dismantle/executor.h"

namespace dismantle {

/// Throws Error when the context says to stop; `doing` names what is given up.
inline void stop_if_asked(const RunContext& context, const char* doing) {
  if (!context.should_stop()) return;
  throw Error(std::string(context.cancel.cancelled() ? "interrupted" : "out of time") + " while " + doing);
}

/// parallel_for on the threads of the context. `doing` names it in progress and errors, `name(i)` an index. Throws when
/// the context says to stop.
template <class Work, class Name>
void parallel_phase(std::size_t n, const RunContext& context, const char* doing, Work&& work, Name&& name) {
  std::size_t done = 0;
  std::mutex progress;
  const auto report = [&](std::size_t i) {
    const std::lock_guard lock(progress);
    context.progress(doing, ++done, n, name(i));
  };
  const auto step = [&](std::size_t i) {
    try {
      work(i);
    } catch (...) {
      report(i);
      throw;
    }
    report(i);
  };
  parallel_for(n, context, step, [&] { return context.should_stop(); });
  stop_if_asked(context, doing);
}

}  // namespace dismantle
