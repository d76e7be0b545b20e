/// Transfer planners: how does a part (or group) get from where it lies to where it is put in? (Algorithm 3, line 5.)
#pragma once

#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_planner.h"

namespace dismantle {

/// Both ends are out of everything, so there is room: this is not the narrow problem of a removal.
struct TransferQuery {
  const Assembly& assembly;
  const Simulator& simulator;
  const PreparedAssembly& prepared;
  /// `moving` start where they lie and move as one rigid body; `fixed` are all others that are anywhere.
  Scene scene;
  /// One pose per moving part: all are taken there by the same displacement of the group.
  std::vector<Pose> goal;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit; the side on which nothing lies
  Budget budget;                                  ///< max_steps counts state checks; max_depth does not apply
  double tolerance;                               ///< as PathQuery::tolerance
  const PathChecker& checker;                     ///< refuses paths that do not end at the goal
};

/// Finds a motion between two given places. An interface of its own and no mode of PathPlanner: a removal has no goal,
/// and a path planner that did not look at one would be wrong silently. Stateless between calls: same parameters, query
/// and seed give the same result. Never prints; polls context.should_stop().
class DISMANTLE_API TransferPlanner {
 public:
  virtual ~TransferPlanner();
  /// Capabilities without which plan() returns `unsupported`.
  virtual Capabilities needs() const noexcept = 0;
  /// The path's last instant is the goal, to rounding. `blocked_by`, `best_pose` as for removals; no `state`.
  virtual PathResult plan(const TransferQuery& query, RunContext& context) = 0;
};

}  // namespace dismantle
