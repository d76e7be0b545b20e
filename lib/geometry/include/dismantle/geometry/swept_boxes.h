/// Boxes around a part along its path: a broad phase that is tighter than one box around the whole path.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// Box around the corners of `box`, moved by `pose`.
Aabb box_under(const Aabb& box, const Pose& pose);

/// Upper bound, rounding included, of the extent of `box`, moved by `pose`, along the unit vector `direction`.
double top_of(const Aabb& box, const Pose& pose, const Eigen::Vector3d& direction);

/// Axis-aligned boxes in the world frame that contain a box at all times of a path: one per segment, and a binary tree
/// over them. Between two poses the box follows a screw motion; the boxes include the bound of its deviation from a
/// straight line.
class SweptBoxes {
 public:
  /// `poses`: one for a fixed part, else one per instant of the path; not empty. `box`: of the part in its own frame.
  SweptBoxes(const std::vector<Pose>& poses, const Aabb& box);

  /// Contains the box at all times.
  const Aabb& whole() const { return nodes_.front().box; }
  /// True if both may be nearer to each other than `distance` at some time. Both have the same number of segments, or
  /// one is fixed.
  bool meets(const SweptBoxes& other, double distance) const;

 private:
  struct Node {
    Aabb box;
    std::size_t right = 0;  // index of the second child (the first follows its parent); 0: a segment
  };
  void build(const std::vector<Aabb>& segments, std::size_t begin, std::size_t end);
  bool meets(std::size_t node, const SweptBoxes& other, std::size_t there, double distance) const;

  std::vector<Node> nodes_;  // parents before children
};

}  // namespace dismantle::geometry
