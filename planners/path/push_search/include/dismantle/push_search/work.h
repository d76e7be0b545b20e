/// The work of a push search, and its limits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "dismantle/run_context.h"

namespace dismantle::push {

/// What one call of a search may use. Work: simulated steps and state checks.
struct Limits {
  Deadline deadline;
  std::uint64_t* work_left = nullptr;  ///< counted down; nullptr = no limit
  /// States expanded in this call and in the paused calls before it; 0 = no limit. Expansions of the resumed search
  /// count, up to half of the limit.
  std::uint64_t expansions = 0;
  unsigned rank = ~0U;            ///< states of greater rank are not expanded
  std::uint64_t pause_after = 0;  ///< work of this call, rounded up to whole states; 0 = no pause
  std::function<void()> between;  ///< called before each expansion, may block; may be empty

  /// `pause_after` once `used` is spent. At least 1, so that the search advances.
  std::uint64_t pause_left(std::uint64_t used) const {
    return pause_after == 0 ? 0 : std::max<std::uint64_t>(pause_after - std::min(pause_after, used), 1);
  }
};

/// Counts the work of all calls.
class Work {
 public:
  /// `context` outlives this.
  explicit Work(const RunContext& context) : context_(&context) {}

  /// Begins a call with these limits.
  void begin(const Limits& limits);
  void count_steps(std::uint64_t steps) { steps_ += steps, spend(steps); }
  void count_check() { ++state_checks_, spend(1); }
  /// No work or time is left, or the run has been cancelled.
  bool used_up() const;
  /// The call has done the work after which it pauses.
  bool pauses() const { return pauses_ && total() >= pause_at_; }

  std::uint64_t steps() const { return steps_; }
  std::uint64_t state_checks() const { return state_checks_; }
  std::uint64_t total() const { return steps_ + state_checks_; }

 private:
  void spend(std::uint64_t work) {
    if (left_ != nullptr) *left_ -= std::min(*left_, work);
  }

  const RunContext* context_;
  Deadline deadline_;
  std::uint64_t* left_ = nullptr;
  bool pauses_ = false;
  std::uint64_t pause_at_ = 0;  ///< in total()
  std::uint64_t steps_ = 0, state_checks_ = 0;
};

}  // namespace dismantle::push
