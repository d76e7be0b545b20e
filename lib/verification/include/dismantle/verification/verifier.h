/// Checks motions on the original triangles; shares nothing with any simulator (docs/plan-format.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/executor.h"
#include "dismantle/export.h"
#include "dismantle/geometry/poll.h"
#include "dismantle/path_planner.h"
#include "dismantle/run_context.h"

namespace dismantle {

namespace geometry {
struct Solid;
}

/// Work that the verifier may spend on proofs, per pair of solids, as counts, so that answers do not depend on the
/// machine. If a proof needs more, the motion is refused as uncertain.
struct VerifyBudget {
  std::uint64_t tests = 1'000'000;          ///< sweep tests for a rung that decides, > 0
  std::uint64_t tests_per_segment = 8'000;  ///< added for each segment of the path
  std::uint64_t patches = 80'000;           ///< surface patches for a rung that decides, > 0
  std::uint64_t overlap_factor = 5;  ///< factor on `patches` for pairs whose initial overlap exceeds the tolerance
  double trial_share = 0.1;          ///< share of both for rungs that may fail, and for passes(), (0, 1]
  double resolution = 0.125;         ///< division ends at this share of the allowed penetration, (0, 1]

  /// The budget with `factor` times as many tests and patches.
  VerifyBudget times(double factor) const;
};

/// Assembly units; the largest edge of an assembly is 10, unless it was scaled otherwise.
inline constexpr double kDefaultTolerance = 0.001;

/// How strict the verifier is.
struct VerifyOptions {
  double max_penetration = kDefaultTolerance;  ///< assembly units, > 0; above the pair's initial overlap
  VerifyBudget budget = {};
};

/// Where a check failed.
struct Violation {
  PartId part = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of `part`, its assembled frame
  double depth = 0;         ///< measured depth of `point` in `other`; beyond the limit there unless `uncertain`
  double allowed = 0;       ///< initial overlap of the pair; 0 outside the region of the overlap
  bool elsewhere = false;   ///< the pair has an initial overlap, but not at this place
  std::size_t segment = 0;  ///< path segment (between instants segment and segment + 1)
  double u = 0;             ///< place in the segment, [0, 1]
  bool uncertain = false;   ///< the proof failed, but no point beyond the limit was found
};

/// The verifier's answer about a motion.
struct MotionCheck {
  bool valid = false;
  double max_penetration =
      0;  ///< valid: certified upper bound above the initial overlap (a rung: max_penetration / 100 or more)
  std::optional<Violation> violation;
  std::uint64_t tests = 0;   ///< elementary sweep tests done
  bool interrupted = false;  ///< the check was stopped, so the motion is not valid
};

/// Rule (b) on the original triangles, proved for every instant, not sampled.
///
/// The law. The depth of a surface point of one part in another part is its distance to the other's surface if it lies
/// inside. Parts are checked shell by shell (an outer shell with its voids), so that overlapping shells hide nothing.
/// At every instant of the screw motions between poses, for every two parts that move relative to each other:
///   1. no surface point is deeper than the pair's initial overlap plus max_penetration;
///   2. neither part passes through the other, however thin it is. To ensure this, either a point on a triangle of
///      thickness h (inward ray to the opposite side, the least of four samples) is no deeper than initial overlap
///      plus h / 4, in both parts; or one copy of a part, shrunken by no more than that everywhere, stays off the
///      other part's surface all the time.
///   3. if the measured initial overlap exceeds ten times max_penetration, it is allowed only in its region: points
///      outside the region obey both laws as if there were no overlap. The region is a box around all of the initial
///      overlap, grown by its depth and max_penetration. It is attached to both parts: a point is in it if it is in
///      the box in the assembled frame of either part. So a pin that leaves along its axis takes one region along, and
///      its following points pass through the region of the other part. An overlap that the user declares, or that is
///      in a flexible part, has no region.
/// A part inside a void of another part is outside its material.
///
/// A pair with an open part has another law, which needs no inside: at every instant one copy of one of the two parts,
/// displaced by no more than the initial overlap plus max_penetration anywhere, meets no triangle of the other, and it
/// is the same copy all the time. So no point is behind a wall by more than that, measured along the path from its own
/// side. At rest, before and after the motion, the own side of a sheet is that to which the shortest displacement takes
/// it off the other part. The initial overlap of such a pair is the smallest displacement that suffices when assembled;
/// it has no region.
///
/// Accepted means proved. Refused means that a point
/// beyond the limit was found, or (`uncertain`) that the proof failed at the resolution or within the counts of
/// VerifyBudget. Motions that keep to 0.4 times the limit are not refused at ordinary corners.
///
/// The proof: displace the corners of a triangle by at most e. If the displaced triangle sweeps a hull that meets no
/// triangle of the other part, and one of its points is outside the other part, no point of the original triangle gets
/// deeper than e. For straight motion the swept hull is exact, and a whole slide is one test per triangle. Turning
/// motion is cut into intervals whose sagitta is covered by a margin.
///
/// Built once per assembly; const functions are safe to call from several threads.
class DISMANTLE_API Verifier {
 public:
  /// Idle threads of the context's executor help to build it; the result does not depend on them. @throws Error when
  /// the context says to stop while parts with many thousand triangles are prepared.
  Verifier(const Assembly& assembly, VerifyOptions options, const RunContext& context = {});
  ~Verifier();

  /// Checks rule (b): the moving parts follow `path` (columns as `moving`) past `fixed`. Pairs that do not move
  /// relative to each other are not checked.
  MotionCheck check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                           const Path& path) const;
  /// The same on the threads of `context`, until it says to stop.
  MotionCheck check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed, const Path& path,
                           const RunContext& context) const;
  /// Rule (b) for one part past another, for callers with many such questions. True is proved, as by check_motion().
  /// False means refused, or not proved with VerifyBudget::trial_share of the budget.
  bool passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& poses) const;
  /// Rule (c): the hulls of all original vertices of `group` and of `rest` are disjoint.
  bool apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;
  const VerifyOptions& options() const;
  std::size_t parts() const;
  /// The only region where two parts may be deeper in each other than max_penetration; assembly units, assembled frame.
  /// nullopt: the initial overlap is allowed everywhere (law 1).
  std::optional<Aabb> overlap_region(PartId a, PartId b) const;
  /// Corners of the convex hull of a part, in its assembled frame.
  const std::vector<Eigen::Vector3d>& hull(PartId part) const;
  /// The part's closed shells, as the checks see them.
  const std::vector<geometry::Solid>& solids(PartId part) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A mesh prepared for depth queries; reuse it when one part meets several others. Immutable.
class DISMANTLE_API DepthBody {
 public:
  explicit DepthBody(const Mesh& mesh, const geometry::Poll& poll = {});
  ~DepthBody();
  DepthBody(DepthBody&&) noexcept;
  DepthBody& operator=(DepthBody&&) noexcept;
  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

/// How deep two parts penetrate each other, and where. If `depth` is 0, they do not, and `point` is undefined.
struct Penetration {
  double depth = 0;                                 ///< >= 0, in the unit of the meshes
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< deepest surface point found, world
};

/// Depth in assembly units to which the surfaces of the two meshes penetrate each other: the largest distance from a
/// surface point of one, inside the other, to the other's surface, both ways. Measured shell by shell, as in the
/// verifier's law. Exact to `tolerance` (> 0) from below; 0 when they only touch. If the search exceeds its fixed
/// budget, the result is the deepest point so far: still a lower bound, so an allowance derived from it is never too
/// large. Poses place the meshes. @throws std::invalid_argument unless tolerance > 0.
DISMANTLE_API double penetration_depth(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                       double tolerance);
/// The same with the place of the deepest point.
DISMANTLE_API Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b,
                                              const Pose& pose_b, double tolerance);
/// Penetration depth of two parts at two poses; assembly units, >= 0, exact up to `tolerance`.
DISMANTLE_API double penetration_depth(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                       double tolerance);

}  // namespace dismantle
