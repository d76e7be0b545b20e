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

/// Calls work(i) for i in [0, n) on up to `threads` threads, until stop(). Of several exceptions the one with the
/// lowest index is thrown, as if the loop had been serial.
template <class Work, class Stop>
void on_threads(std::size_t n, unsigned threads, Work&& work, Stop&& stop) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(n);
  const auto run = [&] {
    for (std::size_t i = next++; i < n && !stop(); i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();  // thrown again below
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, n); ++i) helpers.emplace_back(run);
    run();
  }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

/// Calls work(i) for i in [0, n) on up to context.threads threads; `doing` names it in progress and errors.
/// Exceptions as in on_threads; when told to stop it throws.
template <class Work, class Name>
void parallel_for(std::size_t n, const RunContext& context, const char* doing, Work&& work, Name&& name) {
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
  on_threads(n, context.threads, step, [&] { return context.should_stop(); });
  stop_if_asked(context, doing);
}

}  // namespace dismantle
