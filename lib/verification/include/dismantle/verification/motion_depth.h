/// Measures how deep an invalid motion penetrates, on the original triangles along the whole path.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/path_planner.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// The instant at which a pair exceeds its initial overlap most.
struct MotionDepth {
  PartId part = 0, other = 0;                       ///< `part` moves
  double depth = 0;                                 ///< measured, assembly units; a lower bound
  double allowed = 0;                               ///< initial overlap of the pair; 0 if `valid_ones`
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

/// Prepares each part when it is first needed. Not safe to share between threads.
class DISMANTLE_API MotionDepthMeter {
 public:
  /// All arguments must outlive the meter.
  MotionDepthMeter(const Assembly& assembly, const Verifier& verifier);
  ~MotionDepthMeter();

  /// The pair with the largest excess when `moving` follows `path` (columns as `moving`) past `fixed`. A depth changes
  /// by no more than a point travels, which bounds it between measured poses. The interval with the highest bound is
  /// halved until none can hold more than was found. When told to stop, returns the deepest pair so far, not `proved`.
  /// Returns nullopt when nothing was measured, also because no pair came into reach. `valid_ones`: pairs with a valid
  /// motion are measured, too, and the initial overlap is not deducted; else such pairs count as not penetrating.
  std::optional<MotionDepth> deepest(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                     const Path& path, const MotionDepthOptions& options, const RunContext& context,
                                     bool valid_ones = false);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle
