/// The motion of one part in the frame of another, with bounds of its deviation from straight lines.
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
  /// Poses of part A and of part B by instant; a part with a single pose stays fixed. `box` holds the points of A (its
  /// assembled frame) for which deviation() has to hold. At least one pose each; equal numbers if both move.
  RelativeMotion(std::vector<Pose> a, std::vector<Pose> b, const Aabb& box);

  std::size_t segments() const { return at_instant_.size() - 1; }
  /// Takes points of A to the frame of B.
  Pose at(double s) const;
  /// Does one of the parts stay fixed in segment k? Then the other's screw motion is the relative motion.
  bool is_screw(std::size_t k) const { return screws_[k].known; }
  const std::array<Eigen::Vector3d, 8>& corners() const { return corners_; }  ///< of the box
  /// Does no point of the box move by more than `tolerance` in the frame of B?
  bool constant(double tolerance) const;
  /// Bound of the distance of a triangle of A, at any time of [s0, s1], from the triangle whose corners are
  /// (1 - w) x(s0) + w x(s1) for some w in [0, 1]. s0 and s1 are instants or lie in one segment.
  double deviation(double s0, double s1) const;
  /// A segment in which one of the parts stays fixed: velocity v + w x (x - origin) of the other at the positions of
  /// A's points at its beginning (assembled frame).
  struct Screw {
    bool known = false;
    Eigen::Vector3d w, v, origin;
    Placement start;
  };
  /// deviation() for a few points: a rotation bends the paths of points near its axis far less than those of the
  /// corners of the box. Computed once for an interval, evaluated at many points.
  class Bend {
   public:
    /// Bound for the points within `radius` of `center`, all of them in the box.
    double at(const Eigen::Vector3d& center, double radius) const;

   private:
    friend class RelativeMotion;
    struct Offset {  // of an instant from the chord: an affine map of the points
      Eigen::Matrix3d m;
      Eigen::Vector3d t;
      double stretch;  // norm of m
    };
    std::vector<Offset> offsets_;
    double along_ = 0;              // between instants, at most
    double whole_ = 0;              // deviation() of the box
    const Screw* screw_ = nullptr;  // of the one segment, if it has one
    double share2_ = 0;             // of that segment, squared
  };
  Bend bend(double s0, double s1) const;
  /// Box in the frame of B that holds the box of A at all times.
  Aabb swept_box() const;
  /// swept_box() of each segment. Not empty when A or B moves.
  std::vector<Aabb> segment_boxes() const;

 private:
  double chord_deviation(std::size_t i, std::size_t j) const;
  std::vector<Pose> a_, b_;
  std::array<Eigen::Vector3d, 8> corners_;
  std::vector<Placement> at_instant_;
  std::vector<Screw> screws_;  // by segment
  std::vector<double> bend_;   // by segment: bound of the second derivative of a point's path in the frame of B
};

}  // namespace dismantle::geometry
