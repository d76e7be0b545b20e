/// Planners that join the start to disassembled states: a roadmap, two trees.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dismantle/ompl/disassembled_goal.h"
#include "dismantle/ompl/space_search.h"

namespace dismantle::sampling {

/// An OMPL planner with solution(), discard(), nodes(), iterations() and farthest(), in one state space. Its goal is a
/// DisassembledGoal of `goals` states.
template <class Planner>
class StartAndGoals final : public SpacePlanner {
 public:
  /// `settings`: what the planner is constructed with, between the problem and the random numbers.
  template <class Settings>
  StartAndGoals(SamplingProblem& problem, std::int64_t goals, const Settings& settings, const Rng& rng)
      : planner_(problem, settings, rng.fork(1)) {
    planner_.setProblemDefinition(
        definition_of(problem, std::make_shared<DisassembledGoal>(problem, static_cast<unsigned>(goals), rng.fork(2))));
  }

  std::vector<StateType> solve(const ompl::base::PlannerTerminationCondition& stop) override {
    return planner_.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION ? planner_.solution()
                                                                             : std::vector<StateType>{};
  }
  void discard(std::size_t edge) override { planner_.discard(edge); }
  std::uint64_t nodes() const override { return planner_.nodes(); }
  std::uint64_t iterations() const override { return planner_.iterations(); }
  std::optional<StateType> farthest() const override { return planner_.farthest(); }

 private:
  Planner planner_;
};

}  // namespace dismantle::sampling
