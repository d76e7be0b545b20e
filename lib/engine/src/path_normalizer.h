/// Brings a planner's path into the form that is verified and written.
#pragma once

#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/path_planner.h"

namespace dismantle {

/// Relative error that a planner's poses may have: they may have been computed in single precision.
inline constexpr double kPoseError = 1e-6;

/// Equal up to a relative error of quaternions and, relative to `size` of the assembly, of displacements.
bool same_pose(const Pose& a, const Pose& b, double error, double size);

/// Ball around a part, assembled frame, assembly units.
struct PartBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// A path as docs/plan-format.md requires it, or why there is none.
struct NormalizedPath {
  Path path;
  std::vector<double> lengths;        ///< for each instant, the length of the way from the start; assembly units
  std::vector<double> given_lengths;  ///< the same for each instant of the given path
  std::string problem;                ///< not empty: the given path is unusable

  /// Index of the last given instant at or before parameter `u` in [0, 1] of `segment`, which begins at instant
  /// `segment`.
  std::size_t given_instant(std::size_t segment, double u) const;
};

/// Immutable; safe to share between threads.
class PathNormalizer {
 public:
  explicit PathNormalizer(const Assembly& assembly);

  /// The same motion with the fewest instants that describe it to within tolerance(), but enough that no point of a
  /// part travels further than max_travel() from one to the next. At least two instants. The first is exactly the pose
  /// of the scene. Refuses paths that are not finite, have the wrong width or start elsewhere.
  NormalizedPath normalize(const Path& path, const std::vector<PlacedPart>& moving) const;

  /// Upper bound of the way of any point of the moving parts; assembly units.
  double length(const Path& path, const std::vector<PlacedPart>& moving) const {
    return lengths_along(path, moving).back();
  }
  /// Mean displacement of the centres of the moving parts from the first to the last pose; assembly units.
  Eigen::Vector3d displacement(const Path& path, const std::vector<PlacedPart>& moving) const;

  double size() const { return size_; }              ///< largest edge of the assembly, assembly units
  double max_travel() const { return max_travel_; }  ///< assembly units
  double tolerance() const { return tolerance_; }    ///< assembly units

 private:
  double travel(const std::vector<Pose>& a, const std::vector<Pose>& b, const std::vector<PlacedPart>& moving) const;
  std::vector<double> lengths_along(const Path& path, const std::vector<PlacedPart>& moving) const;
  std::vector<std::size_t> essential(const Path& path, const std::vector<double>& lengths,
                                     const std::vector<PlacedPart>& moving) const;

  std::vector<PartBall> balls_;  // by part id
  double size_ = 0;
  double max_travel_ = 0;
  double tolerance_ = 0;
};

}  // namespace dismantle
