/// Threads that compute attempts, some of them before they are asked for.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dismantle/crew.h"
#include "attempt_runner.h"

namespace dismantle {

struct LogLine {
  LogLevel level = LogLevel::info;
  std::string text;
};

struct PooledAttempt {
  ComputedAttempt computed;
  std::vector<LogLine> log;  ///< what the attempt logged, for the thread that asked to pass on
};

/// What is asked for has the place of the one who waits for it; what is computed ahead takes those that nobody has. An
/// answer depends on nothing but its question: what was computed ahead is the same as what would be computed when
/// asked, and what was interrupted is forgotten.
class AttemptPool {
 public:
  /// Computes on worker `index`; throws nothing.
  using Compute = std::function<ComputedAttempt(unsigned index, const Attempt&, const AttemptKey&, const RunContext&)>;

  /// As many workers as the crew has threads. `context`: deadline for what is computed ahead.
  AttemptPool(std::shared_ptr<Crew> crew, Compute compute, const RunContext& context);
  /// Cancels what is running and waits for it.
  ~AttemptPool();
  AttemptPool(const AttemptPool&) = delete;
  AttemptPool& operator=(const AttemptPool&) = delete;

  /// Replaces what was hinted and not begun. What is running and neither asked for nor hinted any more is cancelled.
  void hint(std::vector<std::pair<AttemptKey, Attempt>> attempts);
  /// Waits for the answer, or until `context` says to stop. One caller at a time.
  PooledAttempt take(const AttemptKey& key, const Attempt& attempt, const RunContext& context);
  /// Attempts computed to the end that nobody has taken.
  std::uint64_t untaken() const;

 private:
  struct Job {
    Attempt attempt;
    bool running = false;
    bool done = false;
    bool asked = false;
    bool has_own_place = false;
    bool awaited = false;      ///< by one who has left his place ...
    bool hands_place = false;  ///< ... and gets that of the worker, before others can take it
    std::uint64_t begun = 0;   ///< order of beginning
    Deadline deadline;
    CancelToken cancel;
    PooledAttempt result;
  };
  using Jobs = std::map<AttemptKey, std::shared_ptr<Job>>;

  void work(unsigned index);
  bool may_begin();
  void make_room();
  std::shared_ptr<Job> demand(const AttemptKey& key, const Attempt& attempt, const RunContext& context);

  Compute compute_;
  Deadline deadline_;
  const std::shared_ptr<Crew> crew_;
  mutable std::mutex mutex_;
  std::condition_variable work_there_, job_ended_;
  Jobs jobs_;
  std::deque<AttemptKey> queue_;
  unsigned running_ = 0;
  std::uint64_t begun_ = 0;
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace dismantle
