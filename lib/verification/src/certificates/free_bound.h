/// Lower bound of a linear function over the free part of a box.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// A closed body in a frame along its largest faces, where boxes fit best.
class FreeBound {
 public:
  explicit FreeBound(const Body& body);
  /// Assembled = frame * local.
  const Eigen::Quaterniond& frame() const { return frame_; }
  /// A lower bound of direction . x over all points of the box that are not inside the body; infinity if the whole box
  /// is inside. All arguments are in the local frame, the box along its axes.
  ///
  /// The free part of the box is bounded by planes. A linear function is least at one of its corners: a corner of the
  /// box that is not inside the body, or a corner of a triangle clipped to the box.
  double least(const Vec3& center, const Vec3& half, const Vec3& direction) const;

 private:
  Eigen::Quaterniond frame_;
  Body local_;
  std::vector<Aabb> boxes_;  ///< of the triangles
};

}  // namespace dismantle::certificates
