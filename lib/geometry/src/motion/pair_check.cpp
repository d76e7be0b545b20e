#include "dismantle/geometry/pair_check.h"

#include <optional>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/motion_samples.h"
#include "dismantle/geometry/starts_off.h"

namespace dismantle::geometry {
namespace {

/// Share of the budget for the first try: about as many tests as samples.
constexpr double kQuickShare = 0.05;

Finding second_of_pair(Finding f) {
  f.of_second = true;
  return f;
}

/// Check of the second direction, started by an idle thread during the first, with the common budget.
class Ahead {
 public:
  Ahead(const Solid& a, const Solid& b, const RelativeMotion& motion, const Limits& limits, const Budget& budget)
      : budget_(budget) {
    if (budget.context == nullptr || !budget.context->executor) return;
    if (a.mesh.triangles.size() + b.mesh.triangles.size() < 1000) return;  // not worth a task
    own_.deadline = budget.context->deadline;
    own_.executor = budget.context->executor;
    budget_.context = &own_;
    task_ = own_.executor->submit([&, limits] { found_ = DirectedCheck(a, b, motion, limits, budget_).run(); },
                                  Executor::Priority::fork_join);
  }
  ~Ahead() { own_.cancel.cancel(); }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;

  /// The finding, if the check was started and needed no more than the budget that the first direction left.
  std::optional<Finding> found(Budget& left) {
    if (!task_ || task_.withdraw()) return std::nullopt;
    task_.wait(*left.context, own_.cancel);
    const std::uint64_t patches = before_.patches_left - budget_.patches_left,
                        tests = budget_.tests_done - before_.tests_done;
    if (found_.answer == Answer::exhausted || tests > left.tests_left || patches > left.patches_left)
      return std::nullopt;
    left.tests_left -= tests;
    left.tests_done += tests;
    left.patches_left -= patches;
    return found_;
  }

 private:
  RunContext own_;
  Budget budget_;
  const Budget before_ = budget_;
  Finding found_;
  Executor::TaskHandle task_;  // last: its destructor waits for the thread that uses the members above
};

/// A displaced copy of one part, or of the other, stays off the other's surface: either proves that neither passes a
/// wall of the other. Copies of open parts are tried leaning both ways, and little, as a sheet in a slot needs it.
Finding check_walls(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                    const Limits& limits, Budget& budget) {
  constexpr double kLittle = 0.02;  // of the tolerance
  std::optional<Finding> failed;
  const auto certified = [&](bool second, double share, Lean lean) {
    Limits part = limits;
    part.penetration *= share;
    Finding found = second ? DirectedCheck(b, a, backward, part, budget, lean).run()
                           : DirectedCheck(a, b, forward, part, budget, lean).run();
    found.of_second = second;
    if (found.answer == Answer::certified) return true;
    // The first failure tells where; one that is not sure outweighs those that are.
    if (!failed || (failed->answer == Answer::violated && found.answer != Answer::violated)) failed = found;
    return false;
  };
  for (const double share : {1.0, kLittle}) {
    if (share < 1 && limits.penetration < limits.cells_from()) break;  // little already
    for (const Lean lean : {Lean::back, Lean::front})
      for (const bool second : {false, true})
        if ((lean == Lean::back || (second ? b : a).open) && certified(second, share, lean)) return {};
  }
  return *failed;
}

}  // namespace

Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget) {
  if (a.open || b.open) return check_walls(a, b, forward, backward, limits, budget);
  const bool swap = b.mesh.triangles.size() < a.mesh.triangles.size();
  const Solid &first = swap ? b : a, &second = swap ? a : b;
  const RelativeMotion &there = swap ? backward : forward, &back = swap ? forward : backward;

  Ahead ahead(second, first, back, limits, budget);
  DirectedCheck check(first, second, there, limits, budget);
  const Finding one = check.run();
  if (one.answer != Answer::certified) return swap ? second_of_pair(one) : one;
  // If a single shrunken copy of `first` never touched the surface of `second`, and `second` is not inside it, then all
  // points of `second` in `first` lie in the removed layer: no deeper than the limit.
  if (check.by_shrunken_copy() && starts_off(second, first, Placement(back.at(0)), limits.most())) return one;
  const std::optional<Finding> known = ahead.found(budget);
  const Finding two = known ? *known : DirectedCheck(second, first, back, limits, budget).run();
  return swap ? two : second_of_pair(two);
}

namespace {

/// Motions of the solids of one part past those of a part at rest.
struct SolidPair {
  const Solid &a, &b;
  RelativeMotion forward, backward;
};

/// Calls use(pair) for the solids that come near each other, until it returns false; then returns false.
template <class Use>
bool each_near(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
               const Pose& pose_b, double grown, const Use& use) {
  const auto box_of = [&](const Solid& s) {
    Aabb box = s.box;
    box.inflate(grown);
    return box;
  };
  for (const Solid& x : a)
    for (const Solid& y : b) {
      std::vector<Pose> path;
      for (const Pose& p : poses_a) path.push_back(p * x.frame);
      const std::vector<Pose> rest{pose_b * y.frame};
      RelativeMotion forward(path, rest, box_of(x));
      if (!forward.swept_box().overlaps(y.box)) continue;
      if (!use(SolidPair{x, y, std::move(forward), RelativeMotion(rest, path, box_of(y))})) return false;
    }
  return true;
}

}  // namespace

bool refuted_by_samples(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
                        const Pose& pose_b, const Limits& limits) {
  return !each_near(a, poses_a, b, pose_b, limits.most(), [&](const SolidPair& pair) {
    return !sample_beyond(pair.a, pair.b, pair.forward, pair.backward, limits);
  });
}

bool passes(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
            const Pose& pose_b, const Limits& limits, const Budget& per_pair) {
  return each_near(a, poses_a, b, pose_b, limits.most(), [&](const SolidPair& pair) {
    const auto& [x, y, forward, backward] = pair;
    // A few samples reject most bad motions, and few tests certify most good ones. The other samples cost little
    // compared with a failed proof.
    if (sample_beyond(x, y, forward, backward, limits, SampledTimes::some)) return false;
    Budget budget = per_pair;
    budget.tests_left = static_cast<std::uint64_t>(kQuickShare * static_cast<double>(per_pair.tests_left));
    budget.patches_left = static_cast<std::uint64_t>(kQuickShare * static_cast<double>(per_pair.patches_left));
    Answer answer = check_pair(x, y, forward, backward, limits, budget).answer;
    if (answer == Answer::exhausted) {
      if (sample_beyond(x, y, forward, backward, limits, SampledTimes::others)) return false;
      budget = per_pair;
      answer = check_pair(x, y, forward, backward, limits, budget).answer;
    }
    return answer == Answer::certified;
  });
}

}  // namespace dismantle::geometry
