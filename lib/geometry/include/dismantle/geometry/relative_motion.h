/// Motion of one part in the frame of another, with bounds on its deviation from straight lines.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// A pose as matrix and vector: cheaper to apply to many points.
struct Placement {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  Placement() = default;
  explicit Placement(const Pose& p) : r(p.q.toRotationMatrix()), t(p.t) {}
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return r * p + t; }
};

/// Time runs from 0 to segments(); segment k joins instants k and k + 1 by the screw motions of both parts.
class RelativeMotion {
 public:
  /// Poses of parts A and B, instant by instant; a part with a single pose is fixed. `box` contains the points of A (in
  /// its assembled frame) for which deviation() must hold. At least one pose each; equal numbers if both move.
  RelativeMotion(std::vector<Pose> a, std::vector<Pose> b, const Aabb& box);

  std::size_t segments() const { return at_instant_.size() - 1; }
  /// Pose that maps points of A to the frame of B.
  Pose at(double s) const;
  /// True if one of the parts is fixed in segment k: the other's screw motion is the relative motion.
  bool is_screw(std::size_t k) const { return screws_[k].known; }
  const std::array<Eigen::Vector3d, 8>& corners() const { return corners_; }  ///< of the box
  /// True if no point of the box moves by more than `tolerance` in the frame of B.
  bool constant(double tolerance) const;
  /// Bound of the distance between a triangle of A at any time in [s0, s1] and the triangle with the corners (1 - w)
  /// x(s0) + w x(s1), for some w in [0, 1]. s0 and s1 are instants or lie in one segment.
  double deviation(double s0, double s1) const;
  /// A segment in which one part is fixed: velocity field v + w x (x - origin) of the other part in world axes, and the
  /// placement of A at the start of the segment.
  struct Screw {
    bool known = false;
    Eigen::Vector3d w, v, origin;
    Placement start;
  };
  /// The bound of deviation() for points near a given point: points near the axis of a rotation deviate far less than
  /// the corners of the box. Built once per interval and queried for many points.
  class Bend {
   public:
    /// Bound for the points within `radius` of `center`, which all lie in the box.
    double at(const Eigen::Vector3d& center, double radius) const;

   private:
    friend class RelativeMotion;
    struct Offset {  // offset of an instant from the chord, an affine map of the points
      Eigen::Matrix3d m;
      Eigen::Vector3d t;
      double stretch;  // norm of m
    };
    std::vector<Offset> offsets_;
    double along_ = 0;              // bound between instants
    double whole_ = 0;              // deviation() of the box
    const Screw* screw_ = nullptr;  // of the only segment, if it is a screw
    double share2_ = 0;             // square of the covered share of the segment
  };
  Bend bend(double s0, double s1) const;
  /// Box in the frame of B that contains the box of A at all times.
  Aabb swept_box() const;
  /// The same for each segment. Not empty if A or B moves.
  std::vector<Aabb> segment_boxes() const;

 private:
  double chord_deviation(std::size_t i, std::size_t j) const;
  std::vector<Pose> a_, b_;
  std::array<Eigen::Vector3d, 8> corners_;
  std::vector<Placement> at_instant_;
  std::vector<Screw> screws_;  // by segment
  std::vector<double> bend_;   // by segment: bound of a point's acceleration in the frame of B
};

}  // namespace dismantle::geometry
