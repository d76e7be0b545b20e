/// The OMPL goal "disassembled" for planners that want states of it.
#pragma once

#include <ompl/base/goals/GoalSampleableRegion.h>

#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::sampling {

/// Hulls apart. Its samples: the start moved out of the box of the rest by each of the six exits, the nearest
/// first, as the bases of Targetless-RRT do; then states drawn at random. All random numbers come from the generator
/// given.
class DisassembledGoal final : public ompl::base::GoalSampleableRegion {
 public:
  using StateType = SamplingProblem::StateType;

  /// `most`: samples in all.
  DisassembledGoal(SamplingProblem& problem, unsigned most, const Rng& rng)
      : GoalSampleableRegion(problem.information()), problem_(problem), most_(most), rng_(rng) {}

  bool isSatisfied(const ompl::base::State* state) const override {
    return problem_.is_out(*static_cast<const StateType*>(state));
  }
  /// 0 in the goal; elsewhere nothing is known but that it is more.
  double distanceGoal(const ompl::base::State* state) const override { return isSatisfied(state) ? 0 : 1; }
  unsigned int maxSampleCount() const override { return most_; }
  /// The next sample. Where none can be drawn the last exit comes again.
  void sampleGoal(ompl::base::State* state) const override;

 private:
  SamplingProblem& problem_;
  unsigned most_;
  mutable Rng rng_;  // OMPL's interface is const
  mutable unsigned next_ = 0;
};

}  // namespace dismantle::sampling
