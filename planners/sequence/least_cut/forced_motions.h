/// Motions that a forced step may take, and how deep they cut in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/twist.h"
#include "dismantle/part_memo.h"
#include "dismantle/part_set.h"
#include "dismantle/path_oracle.h"
#include "least_cut/directional_blockers.h"
#include "least_cut/parameters.h"

namespace dismantle::least_cut {

using Placed = std::vector<PlacedPart>;

/// Some parts of a group leave the others by a translation or a screw motion.
struct ForcedMotion {
  Placed moving, fixed;
  geometry::Twist twist;  ///< velocity of `center`; unit length for straight motions
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double duration = 0;   ///< until the hulls are apart
  double thickness = 0;  ///< of material in the way, mean over rays between the two sides, summed over pairs of parts
  bool sampled = false;  ///< along a direction that no feature of the parts has
  bool straight() const { return twist.angular.isZero(); }
};

/// Compares the thickness in the way, then the length of the path.
bool more_promising(const ForcedMotion& a, const ForcedMotion& b);

/// Keeps measurements of pairs of parts until one of them moves. Not safe to share between threads.
class ForcedMotions {
 public:
  /// All references must outlive it. The oracle has a memo and allows forced steps.
  ForcedMotions(const Assembly& assembly, PathOracle& oracle, const Constraints& constraints,
                const LeastCutParameters& params);

  /// Motions out of a group (two parts or more, ascending) that the constraints allow, most promising first:
  /// translations of single parts and of parts that block each other, and screws of threaded parts.
  std::vector<ForcedMotion> candidates(const Placed& group, const RunContext& context);
  /// The most promising of a few motions: each part alone, along few directions. The cost does not depend on how deep
  /// they cut in. Empty if the constraints let no part leave or the run is stopped.
  std::optional<ForcedMotion> quick_candidate(const Placed& group, const RunContext& context);
  /// Lower bound, from rays, of how deep a straight motion cuts in. Stops once more than `enough` is found. Empty if no
  /// ray enters a part.
  std::optional<MotionDepth> least_depth(const ForcedMotion& motion,
                                         double enough = std::numeric_limits<double>::infinity()) const;
  /// How deep the motion cuts in. Ends early once the depth is known to exceed options.stop_above. When stopped: the
  /// depth found so far, not `proved`. Empty if nothing was measured, or if no two parts come near each other.
  std::optional<MotionDepth> depth(const ForcedMotion& motion, const MotionDepthOptions& options,
                                   const RunContext& context);
  /// Columns as motion.moving.
  Path path(const ForcedMotion& motion) const;

 private:
  using Key = std::tuple<PartId, PartId, std::array<int, 3>>;
  struct Known {
    Pose moving, fixed;    // poses at the time of measuring
    double blocked = 0;    // share of the rays that hit the other part, [0, 1]
    double thickness = 0;  // mean length of the rays inside it, assembly units
    std::optional<MotionDepth> depth{};
    double resolution = std::numeric_limits<double>::infinity();  // with which `depth` was measured; infinity: not yet
  };
  enum class Variety { few, all };
  struct Direction {
    Eigen::Vector3d along;
    bool sampled = false;  ///< as ForcedMotion::sampled
  };
  std::vector<Placed> units(const Placed& group) const;
  std::vector<Direction> directions(const Placed& group, Variety variety);
  std::vector<Eigen::Vector3d> own_directions(const Placed& unit, const std::vector<Direction>& listed);
  const std::vector<geometry::FaceAxis>& axes(PartId part);
  const std::vector<geometry::Twist>& turns(PartId part);
  Known& known(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along);
  /// As known(), but stores nothing for pairs that never meet, which are most pairs in a large group.
  const Known& blocking(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along);
  bool in_reach(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along, double distance) const;
  void send_rays(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along, Known& entry) const;
  double reach(const PlacedPart& part, const Eigen::Vector3d& along) const;
  bool allowed(const Placed& moving, const Placed& group) const;
  void add_straight(const Placed& unit, const std::vector<Placed>& all, const Placed& group, const Direction& along,
                    std::vector<ForcedMotion>& list, const RunContext& context);
  void add_screws(const Placed& unit, const Placed& group, std::vector<ForcedMotion>& list);
  ForcedMotion straight(const Placed& moving, const Placed& group, const Eigen::Vector3d& along);
  const std::vector<geometry::Solid>& solids(PartId part) const;
  const std::vector<Eigen::Vector3d>& hull(PartId part) const;
  double distance_apart(const ForcedMotion& motion, const Eigen::Vector3d& along) const;
  double thickness(const ForcedMotion& motion, const Eigen::Vector3d& along);

  const Assembly& assembly_;
  PathOracle& oracle_;
  const Constraints& constraints_;
  const LeastCutParameters& params_;
  std::vector<std::vector<geometry::FaceAxis>> axes_;               // by part, made when first needed
  std::vector<std::optional<std::vector<geometry::Twist>>> turns_;  // by part, in its frame
  std::map<Key, Known> known_;
  std::vector<Aabb> boxes_;  // by part, in its frame
  DirectionalBlockers blockers_;
};

}  // namespace dismantle::least_cut
