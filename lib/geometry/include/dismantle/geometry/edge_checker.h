/// The verifier's answer about a single motion, for path planners that build trees and roadmaps.
#pragma once

#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::geometry {

/// Implemented by path checkers that can also check a motion that neither begins where the parts are nor ends at the
/// goal. The engine's checker is one; edge_checker() finds it.
class DISMANTLE_API EdgeChecker {
 public:
  virtual ~EdgeChecker();
  /// Rule (b) for the screw motions that join these two lists of poses, one for each moving part: proved for every
  /// instant in between, not sampled. Refused: as PathChecker::check(), `instant` is 0. An accepted edge may be part of
  /// a path that check() accepts; it is no VerifiedPath, so `verified` is empty, and `reason`, too.
  /// May be called from several threads at the same time.
  virtual PathCheck check_edge(const std::vector<Pose>& from, const std::vector<Pose>& to) const = 0;
};

/// The edge checker that `checker` is; null: it checks whole paths only.
DISMANTLE_API const EdgeChecker* edge_checker(const PathChecker& checker);
/// Is the answer of check_edge() that the motion is free?
inline bool is_free(const PathCheck& edge) { return edge.reason.empty(); }

}  // namespace dismantle::geometry
