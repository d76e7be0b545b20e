/// How deep parts cut into others when they are pulled straight out as they stand when assembled.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/motion_depth.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Measured pair by pair and remembered: what one part does to another does not depend on what else is there. The work
/// for a pair is bounded by a number of poses.
class StraightCuts {
 public:
  /// All arguments must outlive it.
  StraightCuts(const Assembly& assembly, const Verifier& verifier);

  /// A pair of the motion that rays find deepest: a lower bound. Ends at an excess beyond `enough`.
  std::optional<MotionDepth> by_rays(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                     const Eigen::Vector3d& out, double enough, const RunContext& context);
  /// The deepest pair, to a few tolerances, enough to compare motions; one beyond `enough` when there is one. nullopt:
  /// nothing cuts in, or `context` says to stop.
  std::optional<MotionDepth> deepest(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                     const Eigen::Vector3d& out, double enough, const RunContext& context);
  /// The same to a tolerance.
  std::optional<MotionDepth> exactly(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                     const Eigen::Vector3d& out, const RunContext& context);

 private:
  using Key = std::tuple<PartId, PartId, std::array<double, 3>>;
  struct Pair {
    bool traced = false, whole = false;   // whole: the measurement was not ended early
    std::optional<MotionDepth> by_ray{};  // a lower bound
    std::optional<MotionDepth> cut{};
  };

  Pair& pair(PartId moving, PartId fixed, const Eigen::Vector3d& out);
  /// After so far, the boxes of the two are apart; not positive: the moving one is past the other.
  double reach(PartId moving, PartId fixed, const Eigen::Vector3d& out) const;
  bool in_reach(PartId moving, PartId fixed, const Eigen::Vector3d& out) const;
  void trace(PartId moving, PartId fixed, const Eigen::Vector3d& out, std::optional<MotionDepth>& deepest) const;
  std::optional<MotionDepth> measure(PartId moving, PartId fixed, const Eigen::Vector3d& out,
                                     const MotionDepthOptions& options, const RunContext& context);

  const Assembly& assembly_;
  const Verifier& verifier_;
  MotionDepthMeter meter_;
  std::map<Key, Pair> pairs_;
};

}  // namespace dismantle
