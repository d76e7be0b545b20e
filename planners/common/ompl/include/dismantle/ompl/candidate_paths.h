/// Shows sequences of states to the checker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/path_planner.h"

namespace dismantle::sampling {

/// Checks the simplified path first, and the original one if that is refused.
class CandidatePaths {
 public:
  /// The checker must outlive this object.
  CandidatePaths(const PathChecker& checker, bool simplify) : checker_(checker), simplify_(simplify) {}

  /// True: `result` holds the path. False: the motion from state `edge` - 1 to state `edge` is at fault, and `result`
  /// holds the checker's reason. `end`: exact final poses of the moving parts; if empty, those of the last state.
  bool accepts(SamplingProblem& problem, const std::vector<SamplingProblem::StateType>& states, PathResult& result,
               std::size_t& edge, const std::vector<Pose>& end = {});
  /// Number of refused paths; each form counts.
  std::uint64_t refused() const { return refused_; }

 private:
  const PathChecker& checker_;
  bool simplify_;
  std::uint64_t refused_ = 0;
};

}  // namespace dismantle::sampling
