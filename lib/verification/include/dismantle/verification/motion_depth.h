/// Measures how deep an invalid motion penetrates, on the original triangles along the whole path.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/motion_depth.h"
#include "dismantle/path_planner.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Prepares each part when it is first needed. Not safe to share between threads.
class DISMANTLE_API MotionDepthMeter {
 public:
  /// All arguments must outlive the meter.
  MotionDepthMeter(const Assembly& assembly, const Verifier& verifier);
  ~MotionDepthMeter();

  /// The pair with the largest excess when `moving` follows `path` (columns as `moving`) past `fixed`. Of a motion
  /// without turns all that the surfaces sweep is searched as a whole. Else poses are measured: a depth changes by no more
  /// than a point travels, which bounds it between them, and the interval with the highest bound is halved until none
  /// can hold more than was found. Outside the region of an initial overlap (Verifier, law 3) nothing
  /// is allowed: there `allowed` is 0; not looked at when the answer may be off by more than the verifier's tolerance
  /// (`absolute`), as for a comparison. When told to stop, returns the deepest pair so far, not `proved`.
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
