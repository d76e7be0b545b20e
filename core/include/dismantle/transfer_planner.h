/// Transfer planners: how does a part (or group) get from the layout to where it is inserted? (Algorithm 3, line 5.)
#pragma once

#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_planner.h"

namespace dismantle {

/// Both ends are in free space: unlike a removal, this is no narrow-passage problem.
struct TransferQuery {
  const Assembly& assembly;
  const Simulator& simulator;
  const PreparedAssembly& prepared;
  /// `moving` start at their layout poses and move as one rigid body; `fixed` are all other parts present.
  Scene scene;
  /// One pose per moving part; one displacement of the group reaches all of them.
  std::vector<Pose> goal;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit; nothing lies on this side
  Budget budget;                                  ///< max_steps counts state checks; max_depth does not apply
  double tolerance;                               ///< as PathQuery::tolerance
  const PathChecker& checker;                     ///< refuses paths that do not end at the goal
};

/// Finds a motion between two given poses. This is not a mode of PathPlanner because a removal has no goal pose: a path
/// planner that ignored it would be silently wrong. Stateless between calls: same parameters, query and seed give the
/// same result. Never prints; polls context.should_stop().
class DISMANTLE_API TransferPlanner {
 public:
  virtual ~TransferPlanner();
  /// Capabilities without which plan() returns `unsupported`.
  virtual Capabilities needs() const noexcept = 0;
  /// The path's last instant equals the goal up to rounding. `blocked_by`, `best_pose` as for removals; no `state`.
  virtual PathResult plan(const TransferQuery& query, RunContext& context) = 0;
};

}  // namespace dismantle
