/// Motions that a forced step may take, and how deep they cut in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "directional_blockers.h"
#include "dismantle/engine/force_options.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/twist.h"
#include "dismantle/path_oracle.h"
#include "dismantle/verification/motion_depth.h"

namespace dismantle {

using Placed = std::vector<PlacedPart>;

std::vector<PartId> ids_of_placed(const Placed& parts);

/// Some parts of a group leave the others by a translation or a screw motion.
struct ForcedMotion {
  Placed moving, fixed;
  geometry::Twist twist;  ///< velocity of `center`; of length 1 where it is straight
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double duration = 0;   ///< until the hulls are apart
  double thickness = 0;  ///< of what is in the way, mean over rays between the two sides, summed over pairs of parts
  bool straight() const { return twist.angular.isZero(); }
};

/// By what is in the way, then by the length of the way.
bool more_promising(const ForcedMotion& a, const ForcedMotion& b);

/// Remembers what it has measured of pairs of parts, as long as they are not moved. Not safe to share between threads.
class ForcedMotions {
 public:
  /// All outlive it.
  ForcedMotions(const Assembly& assembly, const Verifier& verifier, const Constraints& constraints,
                const ForceOptions& options);

  /// Motions out of a group (two parts or more, ascending) that the constraints allow, the most promising first:
  /// translations of parts alone and of those that are in each other's way, and screws of threaded parts.
  std::vector<ForcedMotion> candidates(const Placed& group, const RunContext& context);
  /// The most promising of few: each part alone, along few directions. Its cost does not depend on how deep anything
  /// cuts in. Nothing when the constraints let no part leave, or when the run is stopped.
  std::optional<ForcedMotion> quick_candidate(const Placed& group, const RunContext& context);
  /// A lower bound of how deep a straight motion cuts in, from rays, until more than `enough` is found; nothing where
  /// they meet nothing.
  std::optional<MotionDepth> least_depth(const ForcedMotion& motion,
                                         double enough = std::numeric_limits<double>::infinity()) const;
  /// How deep the motion cuts in. Cut short once it is known to be worse than options.stop_above.
  /// When stopped: what was found until then, not `proved`; nothing when nothing was measured. Nothing, too, when no
  /// two parts come near each other.
  std::optional<MotionDepth> depth(const ForcedMotion& motion, const MotionDepthOptions& options,
                                   const RunContext& context);
  /// Along the whole path, as it is written.
  std::optional<MotionDepth> depth(const ForcedMotion& motion, const Path& path, const MotionDepthOptions& options,
                                   const RunContext& context);
  /// Columns as motion.moving.
  Path path(const ForcedMotion& motion) const;

 private:
  using Key = std::tuple<PartId, PartId, std::array<int, 3>>;
  struct Known {
    Pose moving, fixed;    // where it was measured
    double blocked = 0;    // share of the rays between the two that meet the other, [0, 1]
    double thickness = 0;  // mean length of the rays in it, assembly units
    std::optional<MotionDepth> depth{};
    double resolution = std::numeric_limits<double>::infinity();  // by which `depth` was measured; none yet
  };
  enum class Variety { few, all };
  std::vector<Placed> units(const Placed& group) const;
  std::vector<Eigen::Vector3d> directions(const Placed& group, Variety variety);
  const std::vector<geometry::FaceAxis>& axes(PartId part);
  const std::vector<geometry::Twist>& turns(PartId part);
  std::optional<MotionDepth> depth_at_instants(const ForcedMotion& motion, double enough) const;
  Known& known(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along);
  /// As known(), and remembers nothing of pairs that never meet, which most pairs of many parts are.
  const Known& blocking(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along);
  bool in_reach(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along, double distance) const;
  void send_rays(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along, Known& entry) const;
  double reach(const PlacedPart& part, const Eigen::Vector3d& along) const;
  bool allowed(const Placed& moving, const Placed& group) const;
  void add_straight(const Placed& unit, const std::vector<Placed>& all, const Placed& group,
                    const Eigen::Vector3d& along, std::vector<ForcedMotion>& list, const RunContext& context);
  void add_screws(const Placed& unit, const Placed& group, std::vector<ForcedMotion>& list);
  ForcedMotion straight(const Placed& moving, const Placed& group, const Eigen::Vector3d& along);
  double distance_apart(const ForcedMotion& motion, const Eigen::Vector3d& along) const;
  double thickness(const ForcedMotion& motion, const Eigen::Vector3d& along);

  const Assembly& assembly_;
  const Verifier& verifier_;
  const Constraints& constraints_;
  ForceOptions options_;
  MotionDepthMeter meter_;
  std::vector<std::vector<geometry::FaceAxis>> axes_;               // by part, made when first needed
  std::vector<std::optional<std::vector<geometry::Twist>>> turns_;  // by part, in its frame
  std::map<Key, Known> known_;
  std::vector<Aabb> boxes_;  // by part, in its frame
  DirectionalBlockers blockers_;
};

}  // namespace dismantle
