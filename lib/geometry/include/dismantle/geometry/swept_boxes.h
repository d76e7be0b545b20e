/// Boxes around a part along its path: a broad phase that costs what is near the path, not what its one box holds.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// Box around the corners of `box`, moved by `pose`.
Aabb box_under(const Aabb& box, const Pose& pose);

/// No point within `box`, moved by `pose`, reaches further along the unit vector `direction`, whatever the rounding.
double top_of(const Aabb& box, const Pose& pose, const Eigen::Vector3d& direction);

/// Axis-aligned boxes, in the world frame, that hold a box at all times of a path: one per segment, and a binary tree
/// over them. Between two poses the box follows the screw motion that joins them; the bound on how far that bends away
/// from a straight line is part of the boxes.
class SweptBoxes {
 public:
  /// `poses`: one for a part that does not move, else one per instant of the path; not empty. `box`: of the part in its
  /// own frame.
  SweptBoxes(const std::vector<Pose>& poses, const Aabb& box);

  /// Holds the box at all times.
  const Aabb& whole() const { return nodes_.front().box; }
  /// Could the two be nearer to each other than `distance` at the same time? Both move over the same number of
  /// segments, or one of them does not move.
  bool meets(const SweptBoxes& other, double distance) const;

 private:
  struct Node {
    Aabb box;
    std::size_t right = 0;  // index of the second child; the first follows its parent. 0: a segment
  };
  void build(const std::vector<Aabb>& segments, std::size_t begin, std::size_t end);
  bool meets(std::size_t node, const SweptBoxes& other, std::size_t there, double distance) const;

  std::vector<Node> nodes_;  // parents before children
};

}  // namespace dismantle::geometry
