/// The OMPL goal "disassembled" with samples, for planners that grow from the goal.
#pragma once

#include <ompl/base/goals/GoalSampleableRegion.h>

#include "dismantle/ompl/sampling_problem.h"

namespace dismantle::sampling {

/// Holds if the hulls are disjoint. Samples: the start moved out of the fixed parts' box through each of the six exits,
/// nearest first, as in Targetless-RRT; then random states. All random numbers come from the given generator.
class DisassembledGoal final : public ompl::base::GoalSampleableRegion {
 public:
  using StateType = SamplingProblem::StateType;

  /// `most`: number of samples.
  DisassembledGoal(SamplingProblem& problem, unsigned most, const Rng& rng)
      : GoalSampleableRegion(problem.information()), problem_(problem), most_(most), rng_(rng) {}

  bool isSatisfied(const ompl::base::State* state) const override {
    return problem_.is_separated(*static_cast<const StateType*>(state));
  }
  /// 0 in the goal, 1 elsewhere, because the distance is not known.
  double distanceGoal(const ompl::base::State* state) const override { return isSatisfied(state) ? 0 : 1; }
  unsigned int maxSampleCount() const override { return most_; }
  /// The next sample. If no random state is found, repeats the last exit.
  void sampleGoal(ompl::base::State* state) const override;

 private:
  SamplingProblem& problem_;
  unsigned most_;
  mutable Rng rng_;  // mutable because OMPL's interface is const
  mutable unsigned next_ = 0;
};

}  // namespace dismantle::sampling
