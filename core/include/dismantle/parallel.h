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

#include "dismantle/crew.h"
#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle {

inline void stop_if_asked(const RunContext& context, const char* doing) {
  if (!context.should_stop()) return;
  throw Error(std::string(context.cancel.cancelled() ? "interrupted" : "out of time") + " while " + doing);
}

/// The indices of a loop, taken by one thread after the other until stop().
template <class Work, class Stop>
class Loop {
 public:
  Loop(std::size_t n, Work& work, Stop& stop) : n_(n), work_(work), stop_(stop), errors_(n) {}
  void run() {
    for (std::size_t i = next_++; i < n_ && !stop_(); i = next_++) {
      try {
        work_(i);
      } catch (...) {
        errors_[i] = std::current_exception();  // thrown by check()
      }
    }
  }
  /// Of several exceptions the one with the lowest index is thrown, as if the loop had been serial.
  void check() const {
    for (const auto& error : errors_)
      if (error) std::rethrow_exception(error);
  }

 private:
  const std::size_t n_;
  Work& work_;
  Stop& stop_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::exception_ptr> errors_;
};

/// Calls work(i) for i in [0, n) on up to `threads` threads, until stop(). Exceptions: see Loop.
template <class Work, class Stop>
void on_threads(std::size_t n, unsigned threads, Work&& work, Stop&& stop) {
  Loop loop(n, work, stop);
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, n); ++i) helpers.emplace_back([&] { loop.run(); });
    loop.run();
  }
  loop.check();
}

/// Likewise, with those of the context's crew that are idle, or on up to context.threads threads where it has none.
template <class Work, class Stop>
void on_threads(std::size_t n, const RunContext& context, Work&& work, Stop&& stop) {
  if (!context.crew) return on_threads(n, context.threads, work, stop);
  Loop loop(n, work, stop);
  {
    std::vector<Crew::Offer> helpers;  // who come too late are not needed
    for (std::size_t i = 1; i < std::min<std::size_t>(context.crew->threads(), n); ++i)
      helpers.push_back(context.crew->offer([&] { loop.run(); }, Crew::Rank::part));
    loop.run();
    for (auto& helper : helpers)
      if (!helper.withdraw()) helper.wait();
  }
  loop.check();
}

/// Calls work(i) for i in [0, n) on the threads of the context; `doing` names it in progress and errors.
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
  on_threads(n, context, step, [&] { return context.should_stop(); });
  stop_if_asked(context, doing);
}

}  // namespace dismantle
