/// The same work for each index, on several threads, with results that cannot tell.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle {

inline void stop_if_asked(const RunContext& context, const char* doing) {
  if (!context.should_stop()) return;
  throw Error(std::string(context.cancel.cancelled() ? "interrupted" : "out of time") + " while " + doing);
}

/// Calls work(i) for i in [0, n) on up to context.threads threads; `doing` names it in progress and errors. Of several
/// exceptions the one with the lowest index is thrown, as if the loop had been serial.
template <class Work, class Name>
void parallel_for(std::size_t n, const RunContext& context, const char* doing, Work&& work, Name&& name) {
  std::atomic<std::size_t> next{0}, done{0};
  std::vector<std::exception_ptr> errors(n);
  std::mutex progress;
  const auto run = [&] {
    for (std::size_t i = next++; i < n && !context.should_stop(); i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();  // thrown again below
      }
      const std::lock_guard lock(progress);
      context.progress(doing, ++done, n, name(i));
    }
  };
  const std::size_t helpers = std::min<std::size_t>(std::max(1u, context.threads), std::max<std::size_t>(n, 1)) - 1;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(run);
    run();
  }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
  stop_if_asked(context, doing);
}

}  // namespace dismantle
