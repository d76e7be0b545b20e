/// Path checkers for tests: the verifier's answer, or one that the test makes up.
#pragma once

#include <functional>
#include <utility>

#include "dismantle/path_planner.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::fake {

/// What a test says about a path. Where `accept` is false the other fields are the answer.
struct Ruling : PathCheck {
  bool accept = false;
};

/// The verifier's answer about a motion, without the end of the path: `instant` is where the segment at fault begins.
inline Ruling ruling_of(const MotionCheck& motion) {
  Ruling ruling;
  ruling.accept = motion.valid;
  if (!motion.violation) return ruling;
  ruling.has_witness = true;
  ruling.part = motion.violation->part;
  ruling.other = motion.violation->other;
  ruling.point = motion.violation->point;
  ruling.instant = motion.violation->segment;
  return ruling;
}

/// Accepts paths as they are shown, where the rule says so. The rule may be asked from several threads.
class RuleChecker final : public PathChecker {
 public:
  explicit RuleChecker(std::function<Ruling(const Path&)> rule) : rule_(std::move(rule)) {}
  PathCheck check(const Path& path) const override {
    const Ruling ruling = rule_(path);
    PathCheck answer = ruling;
    if (ruling.accept) answer.verified = accept(path, 0);
    return answer;
  }
  /// Whatever the rule says.
  VerifiedPath verified(const Path& path) const { return accept(path, 0); }

 private:
  std::function<Ruling(const Path&)> rule_;
};

/// A checker that accepts every path.
inline RuleChecker accept_all() {
  return RuleChecker([](const Path&) {
    Ruling ruling;
    ruling.accept = true;
    return ruling;
  });
}

}  // namespace dismantle::fake
