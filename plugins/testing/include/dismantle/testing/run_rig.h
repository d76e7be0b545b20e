/// Sequence planners and helpers for tests of whole runs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/part_set.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::fake {

/// Tries the remaining parts in turn until none leaves, and announces all its questions.
class InTurn : public SequencePlanner {
 public:
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  /// Takes the first group of the start apart.
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceResult result;
    std::vector<PlacedPart> left = query.start.front();
    for (bool removed = true; removed && left.size() > 1;) {
      removed = false;
      result.unsolved.clear();
      std::vector<Attempt> round;
      for (const PlacedPart& p : left) round.push_back(question(left, p));
      oracle.prefetch(round, context);
      for (std::size_t i = 0; i < left.size() && !removed; ++i) {
        const AttemptResult& r = oracle.attempt(question(left, left[i]), context);
        if (is_success(r.result.outcome())) {
          removed = true;
          result.removals.push_back({{left[i].part}, &r});
          left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
          observer.removed(result.removals.back(), left.size());
        } else {
          result.unsolved.push_back({left[i].part, r.result.outcome(), r.result.blocked_by, {}, r.result.message});
        }
      }
    }
    result.remaining = ids_of(left);
    result.outcome = left.size() <= 1 ? Outcome::solved : Outcome::exhausted;
    if (left.size() <= 1) result.unsolved.clear();
    return result;
  }

  static Attempt question(const std::vector<PlacedPart>& left, const PlacedPart& part) {
    const PlacedPart moving[] = {part};
    return {{part}, without(left, moving)};
  }
};

/// Pushes blocks only: the tube, which could leave downwards, stands on a table.
inline PathResult push_blocks(const PathQuery& query, RunContext& context) {
  return query.scene.moving[0].part == 0 ? outcome(Outcome::exhausted) : push(query, context);
}

/// The function that replaces a sequence planner.
using Steps = std::function<SequenceResult(const Assembly&, PathOracle&, SequenceObserver&, RunContext&)>;
/// A sequence planner that is one function.
class Custom final : public SequencePlanner {
 public:
  explicit Custom(Steps steps) : steps_(std::move(steps)) {}
  SequenceResult plan(const SequenceQuery& q, PathOracle& o, SequenceObserver& s, RunContext& c) override {
    return steps_(q.assembly, o, s, c);
  }

 private:
  Steps steps_;
};

/// A run that removes the parts in turn.
inline RunResult run_in_turn(const Assembly& assembly, RunContext context = {}, const RunOptions& options = {}) {
  return run(assembly, setup(push, std::make_shared<InTurn>()), options, context);
}

/// The text of the plan file with all times set to zero.
inline std::string text_without_times(Plan plan) {
  for (auto& step : plan.disassembly) step.seconds = 0;
  for (auto& part : plan.unsolved) part.seconds = 0;
  return to_json(plan);
}

}  // namespace dismantle::fake
