/// How deep a motion cuts in, where it is not valid: measured on the original triangles along the whole path.
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

/// The instant at which a pair is deepest above what it overlaps when assembled.
struct MotionDepth {
  PartId part = 0, other = 0;                       ///< `part` moves
  double depth = 0;                                 ///< measured, assembly units; a lower bound
  double allowed = 0;                               ///< what the pair overlaps when assembled
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< deepest surface point, world
  bool proved = false;  ///< nothing on the path exceeds `excess()` by more than what was asked for
  double excess() const { return depth > allowed ? depth - allowed : 0; }
};

/// How exactly depths along a motion are measured.
struct MotionDepthOptions {
  double absolute = 0;     ///< assembly units: resolution of the answer; 0: VerifyOptions::max_penetration
  double relative = 0.05;  ///< or this share of the depth, whichever is more
  double stop_above = std::numeric_limits<double>::infinity();  ///< an excess beyond this need not be exact
  std::uint64_t most_poses = 4000;                              ///< poses measured per pair; then not `proved`
  /// Assembly units: no pair is deeper than this on the path, as another check has proved. Measuring ends where no
  /// more can be found.
  double at_most = std::numeric_limits<double>::infinity();
  bool known_invalid = false;  ///< no pair's motion is valid: that is not checked before it is measured
};

/// Makes parts ready for measuring when they are first needed. Not safe to share between threads.
class DISMANTLE_API MotionDepthMeter {
 public:
  /// All outlive it.
  MotionDepthMeter(const Assembly& assembly, const Verifier& verifier);
  ~MotionDepthMeter();

  /// The worst pair of the motion of `moving`, which moves as one body along `path` (columns as `moving`), past
  /// `fixed`. Between measured poses depth is bounded by how far a point travels (depth changes by no more than that),
  /// and the interval with the highest bound is halved until none can hold more than was found.
  /// Told to stop: the deepest until then, not `proved`; nothing when nothing was measured. Nothing, too, when no pair
  /// of them has been in reach. `valid_ones`: pairs whose motion is valid
  /// are measured, too, for how much of what they may they use; else they count as not cutting in.
  std::optional<MotionDepth> deepest(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                     const Path& path, const MotionDepthOptions& options, const RunContext& context,
                                     bool valid_ones = false);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle
