/// How far along a direction the free part of a box begins.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// A closed body, in a frame along its faces, where boxes fit best.
class FreeBound {
 public:
  explicit FreeBound(const Body& body);
  /// Assembled = frame * local.
  const Eigen::Quaterniond& frame() const { return frame_; }
  /// The least of direction . x over all points of the box that are not inside the body, or something less; infinity
  /// where all of the box is inside. All of it is in the local frame, the box along its axes.
  ///
  /// What is not inside, and in the box, is bounded by planes. A linear function is least at a corner of it: a corner
  /// of the box that is not inside, or a corner of what the box leaves of a triangle.
  double least(const Vec3& center, const Vec3& half, const Vec3& direction) const;

 private:
  Eigen::Quaterniond frame_;
  Body local_;
  std::vector<Aabb> boxes_;  ///< of the triangles
};

}  // namespace dismantle::certificates
