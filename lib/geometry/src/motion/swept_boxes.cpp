#include "dismantle/geometry/swept_boxes.h"

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/relative_motion.h"

namespace dismantle::geometry {

Aabb box_under(const Aabb& box, const Pose& pose) {
  Aabb moved;
  for (unsigned k = 0; k < 8; ++k)
    moved.extend(pose * Eigen::Vector3d((k & 1 ? box.hi : box.lo).x(), (k & 2 ? box.hi : box.lo).y(),
                                        (k & 4 ? box.hi : box.lo).z()));
  return moved;
}

double top_of(const Aabb& box, const Pose& pose, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d middle = pose * box.center(), half = 0.5 * box.size();
  const double reach = (pose.q.conjugate() * direction).cwiseAbs().dot(half);
  return direction.dot(middle) + (1 + kRounding) * reach + kRounding * middle.norm();
}

SweptBoxes::SweptBoxes(const std::vector<Pose>& poses, const Aabb& box) {
  if (poses.size() == 1) {
    nodes_.push_back({box_under(box, poses.front())});
    return;
  }
  const std::vector<Aabb> segments = RelativeMotion(poses, {Pose{}}, box).segment_boxes();
  nodes_.reserve(2 * segments.size() - 1);
  build(segments, 0, segments.size());
}

void SweptBoxes::build(const std::vector<Aabb>& segments, std::size_t begin, std::size_t end) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  for (std::size_t k = begin; k < end; ++k) nodes_[node].box.extend(segments[k]);
  if (end - begin == 1) return;
  const std::size_t middle = begin + (end - begin) / 2;
  build(segments, begin, middle);
  nodes_[node].right = nodes_.size();
  build(segments, middle, end);
}

bool SweptBoxes::meets(const SweptBoxes& other, double distance) const { return meets(0, other, 0, distance); }

/// Trees over the same number of segments have the same shape, so nodes at the same place cover the same times.
bool SweptBoxes::meets(std::size_t node, const SweptBoxes& other, std::size_t there, double distance) const {
  Aabb around = nodes_[node].box;
  around.inflate(distance);
  if (!around.overlaps(other.nodes_[there].box)) return false;
  const std::size_t right = nodes_[node].right, right_there = other.nodes_[there].right;
  if (right == 0 && right_there == 0) return true;
  return meets(right == 0 ? node : node + 1, other, right_there == 0 ? there : there + 1, distance) ||
         meets(right == 0 ? node : right, other, right_there == 0 ? there : right_there, distance);
}

}  // namespace dismantle::geometry
