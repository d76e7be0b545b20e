/// Path checkers for tests: answers of the verifier, or answers of a rule of the test.
#pragma once

#include <functional>
#include <utility>

#include "dismantle/path_planner.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::fake {

/// Answer of a test about a path. If `accept` is false, the other fields are the answer.
struct Ruling : PathCheck {
  bool accept = false;
};

/// The verifier's answer about a motion, without the check of its end. `instant` begins the first invalid segment.
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

/// Accepts paths by a rule, unchanged. Several threads may call the rule.
class RuleChecker final : public PathChecker {
 public:
  explicit RuleChecker(std::function<Ruling(const Path&)> rule) : rule_(std::move(rule)) {}
  PathCheck check(const Path& path) const override {
    const Ruling ruling = rule_(path);
    PathCheck answer = ruling;
    if (ruling.accept) answer.verified = accept(path, 0);
    return answer;
  }
  /// Accepts `path` independent of the rule.
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
