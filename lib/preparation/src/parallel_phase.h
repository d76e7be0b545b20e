/// A parallel loop that reports its progress and stops when it is told to.
#pragma once

#include <cstddef>
#include <mutex>

#include "dismantle/executor.h"
#include "dismantle/stop_if_asked.h"

namespace dismantle {

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
