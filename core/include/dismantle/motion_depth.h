/// How deep an invalid motion cuts in.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "dismantle/assembly.h"

namespace dismantle {

/// The instant at which a pair exceeds its initial overlap most.
struct MotionDepth {
  PartId part = 0, other = 0;                       ///< `part` moves
  double depth = 0;                                 ///< measured, assembly units; a lower bound
  double allowed = 0;                               ///< initial overlap of the pair; 0 if valid motions were measured
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< deepest surface point, world
  bool proved = false;  ///< nothing on the path exceeds `excess()` by more than the resolution
  double excess() const { return depth > allowed ? depth - allowed : 0; }
};

/// Accuracy and limits of the measurement.
struct MotionDepthOptions {
  double absolute = 0;     ///< assembly units: resolution of the answer; 0: VerifyOptions::max_penetration
  double relative = 0.05;  ///< resolution as a share of the depth, if that is more
  double stop_above = std::numeric_limits<double>::infinity();  ///< measuring ends at an excess beyond this
  std::uint64_t most_poses = 4000;  ///< poses measured per pair; with more needed, the result is not `proved`
  /// Assembly units: depth that no pair exceeds on the path, as another check has proved. Measuring ends when this
  /// leaves no larger depth to find.
  double at_most = std::numeric_limits<double>::infinity();
  bool known_invalid = false;  ///< no pair's motion is valid, so validity is not checked before measuring
};

}  // namespace dismantle
