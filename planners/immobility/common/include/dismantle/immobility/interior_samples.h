/// Sample points deep inside two parts. While no surface penetrates too deep, each point stays outside the other part.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/linear_bound.h"
#include "dismantle/immobility/occupancy.h"

namespace dismantle::immobility {

/// A point of one part that never enters a solid of the other part, its obstacle. The point is deeper in its own part
/// than the obstacle may penetrate, and the obstacle's surface would have to pass it first.
struct InteriorSample {
  bool of_a = true;
  std::uint32_t obstacle = 0;                    ///< index in SampledPair
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< assembled frame, relative to SampledPair::center()
  double clearance = 0;                          ///< distance from the obstacle when assembled
};

/// Two parts and the samples of both. Six coordinates give the pose of `a` relative to `b`, all 0 when assembled: a
/// rotation vector, about the centre, and a shift of the centre.
class SampledPair {
 public:
  /// The plane of a triangle; `normal` has length `length`, twice the area. `edges`: sum of the lengths of two edges.
  struct Plane {
    Eigen::Vector3d normal;
    double length, edges;
  };
  struct Obstacle {
    const Solid* solid;
    Pose to_local;             ///< from the assembled frame
    Eigen::Matrix3d rotation;  ///< of to_local
    Occupancy occupied;
    std::vector<Plane> planes;  ///< by triangle
    double rounding;            ///< error of positions in its frame; assembly units
  };

  /// Samples are at least `depth` (> 0) below the surface, and about `spacing` (> 0) apart, or more in large parts. `a`
  /// and `b` must outlive this.
  SampledPair(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth, double spacing);

  const std::vector<InteriorSample>& samples() const { return samples_; }
  const Obstacle& obstacle(std::uint32_t number) const { return obstacles_[number]; }
  const Obstacle& obstacle(const InteriorSample& sample) const { return obstacles_[sample.obstacle]; }
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }  ///< of `a` about the centre
  /// How far a typical sample moves, in assembly units, per unit of each coordinate.
  const Vector6& scale() const { return scale_; }

 private:
  void add(const Solid& of, std::uint32_t obstacle, bool of_a, double depth, double spacing, double reach);

  std::vector<Obstacle> obstacles_;
  Eigen::Vector3d center_;
  double radius_ = 0;
  std::vector<InteriorSample> samples_;
  Vector6 scale_;
};

/// True if all surfaces are closed. Only then must a sample pass through the surface to get inside.
bool all_closed(const std::vector<Solid>& solids);

/// One pose of `a` relative to `b`.
class RelativePose {
 public:
  RelativePose(const SampledPair& pair, const Vector6& x);
  /// Position of the sample, in the frame of its obstacle.
  Eigen::Vector3d position(const InteriorSample& sample) const;
  bool inside(const InteriorSample& sample) const;
  /// As inside(), but skips the test if the sample has not moved as far as its obstacle.
  bool blocked_by(const InteriorSample& sample) const;
  /// blocked_by() of any of these samples. Fast if successive ones have the same obstacle and are near each other.
  bool blocked_by_any(std::span<const std::uint32_t> samples) const;

 private:
  Eigen::Vector3d moved(const InteriorSample& sample) const;
  Eigen::Vector3d in_frame_of_obstacle(const InteriorSample& sample, const Eigen::Vector3d& moved) const;
  /// Position of a sample that has moved as far as its obstacle, in the frame of that; else nullopt.
  std::optional<Eigen::Vector3d> position_if_near(const InteriorSample& sample) const;

  const SampledPair* pair_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d shift_;
  double max_displacement_;  // upper bound, of any point of `a`
};

}  // namespace dismantle::immobility
