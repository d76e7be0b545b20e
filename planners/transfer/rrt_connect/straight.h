/// Transfers that need no search: lift, rotate, carry over everything, put down.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/transfer_planner.h"

namespace dismantle::rrt_connect {

/// The displacement that takes the group from start to goal. False: the goal is not a rigid displacement of the group.
bool displacement_to_goal(const TransferQuery& query, Pose& displacement);

/// Boxes of the parts in their own frames, kept from one transfer to the next.
class PartBoxes {
 public:
  const Aabb& of(const Part& part);

 private:
  struct Known {
    std::shared_ptr<const Mesh> mesh;  // that the box encloses
    Aabb box;
  };
  std::vector<Known> known_;  // by part
};

/// Candidate paths, the most promising first: over everything on the side `up`, below everything, straight from start
/// to goal, around on the other four sides. The group rotates about its centre, except on the straight path only where
/// all other parts are at least `clearance` (assembly units) away. Computed on demand, since the first is usually free.
class StraightTransfers {
 public:
  /// `query` and `boxes` must outlive this.
  StraightTransfers(const TransferQuery& query, double clearance, PartBoxes& boxes);
  /// Candidate `k`; nothing: there are no more.
  std::optional<Path> path(std::size_t k) const;

 private:
  Path path_of(const std::vector<Pose>& displacements) const;
  Path over(const Eigen::Vector3d& v) const;

  const TransferQuery& query_;
  double clearance_;
  PartBoxes& boxes_;
  bool rigid_;                                        // the goal is a rigid displacement of the group
  Pose goal_;                                         // that displacement
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();  // of a ball around the moving parts, at the start
  double radius_ = 0;
};

}  // namespace dismantle::rrt_connect
