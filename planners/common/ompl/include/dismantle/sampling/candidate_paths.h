/// Shows sequences of states to the checker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::sampling {

/// A path is shown simplified, and as it was found if that is refused.
class CandidatePaths {
 public:
  /// The checker outlives this.
  CandidatePaths(const PathChecker& checker, bool simplify) : checker_(checker), simplify_(simplify) {}

  /// True: `result` holds the path. False: `edge` is that of `states` (from edge - 1 to edge) which is at fault, and
  /// `result` holds the checker's reason. `end`: where the moving parts end exactly; empty: where the last state says.
  bool accepts(SamplingProblem& problem, const std::vector<SamplingProblem::StateType>& states, PathResult& result,
               std::size_t& edge, const std::vector<Pose>& end = {});
  /// Paths that were refused, both forms counted.
  std::uint64_t refused() const { return refused_; }

 private:
  const PathChecker& checker_;
  bool simplify_;
  std::uint64_t refused_ = 0;
};

}  // namespace dismantle::sampling
