/// The judge: checks plans on the original triangles, sharing nothing with any simulator (DESIGN section 7).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/executor.h"
#include "dismantle/export.h"
#include "dismantle/path_planner.h"
#include "dismantle/run_context.h"

namespace dismantle {

struct VerifyOptions {
  double max_penetration = 0.01;  ///< assembly units, > 0; above the pair's initial overlap
};

/// Where a check failed.
struct Violation {
  PartId part = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of `part`, its assembled frame
  double depth = 0;    ///< measured depth at `point` in `other`; beyond what the law allows there unless `uncertain`
  double allowed = 0;  ///< initial overlap of the pair
  std::size_t segment = 0;  ///< path segment (between instants segment and segment + 1)
  double u = 0;             ///< place in the segment, [0, 1]
  bool uncertain = false;   ///< could not be certified at the resolution limit, but no point beyond was found
};

struct MotionCheck {
  bool valid = false;
  double max_penetration = 0;  ///< valid: certified upper bound above the initial overlap (a rung of a fixed ladder)
  std::optional<Violation> violation;
  std::uint64_t tests = 0;   ///< elementary sweep tests done
  bool interrupted = false;  ///< not valid, for it was told to stop
};

/// Two parts that overlap when assembled in such a way that no motion within the limits can part them: a point lies in
/// both, deeper below the surface of `inside` than the pair may penetrate. When they are apart it is outside `other`,
/// so on any way there it passes through the surface of `other`, which then is as deep in `inside`.
struct Lock {
  PartId inside = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< assembled
  double depth = 0;                                 ///< of the point below the surface of `inside`, assembly units
  double allowed = 0;                               ///< the pair's when assembled and max_penetration
};

/// A part that cannot leave, however it moves: a ball within `inside`, less what may be penetrated, is too large for
/// every way out between the parts around it.
struct Enclosure {
  PartId inside = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< the ball's centre, assembled
  double radius = 0;                                ///< assembly units
  std::vector<PartId> around;                       ///< those that bound its room, most of it first
};

/// Two parts that hold each other though nothing of them overlaps: no motion within the limits parts them.
struct Cage {
  enum class Kind {
    ring,   ///< a circle within `inside` is in a chamber of `other`, all of whose openings are narrower
    spool,  ///< `inside` goes through a hole in `other`, between two rims that are wider than a circle about the hole
    hook,   ///< `inside` goes through a hole in `other`, between two bends that cannot follow
    disc,   ///< a flat disc within `inside` is in a chamber of `other`, and gets through none of its openings
  };
  Kind kind = Kind::ring;
  PartId inside = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< the circle's centre, or a point in the hole; assembled
  double size = 0;     ///< diameter of the circle or disc, width of the narrower rim; assembly units; 0 for a hook
  double opening = 0;  ///< diameter of the widest opening, of the circle about the hole, of the hole; 0 for a disc
};

/// Two parts that hold each other as rigid bodies: every motion that begins assembled, and along which they cut in by
/// less than `depth`, stays within bounds. Where the depth is less than what the judge allows, this explains why no way
/// was found, and does not spare the search for one.
struct Confinement {
  PartId inside = 0, other = 0;
  double depth = 0;       ///< assembly units: the overlap of the two when assembled, and a share of max_penetration
  double shift = 0;       ///< the middle of `inside` comes no further, seen from `other`; assembly units
  double turn = 0;        ///< nor does it turn by more; rad
  std::size_t cells = 0;  ///< boxes of poses that the proof is made of
};

/// Parts that hold each other in place as rigid bodies: whoever of them moves, in every motion that begins assembled,
/// and along which no two cut in by `depth` more than when assembled, all of them stay within bounds. As a confinement,
/// this does not spare the search for a way.
struct Interlock {
  std::vector<PartId> parts;    ///< ascending
  double depth = 0;             ///< assembly units: half of max_penetration
  double shift = 0;             ///< no middle comes further, seen from the largest part; assembly units
  double turn = 0;              ///< none turns by more, seen from it; rad
  std::size_t half_spaces = 0;  ///< of poses that the proof is made of
};

/// Rule (b) on the original triangles, proved for every instant, not sampled.
///
/// The law. Depth of a surface point of one part in another: its distance to the other's surface if it lies inside.
/// Parts are taken shell by shell (an outer shell with its voids), so that shells which overlap hide nothing. At
/// every instant of the screw motions between poses, for every two parts that move relative to each other:
///   1. no surface point is deeper than the pair's initial overlap plus max_penetration;
///   2. neither part passes through the other, however thin it is. To that end either a point on a triangle of
///      thickness h (inward ray to the opposite side, the least of four samples) is no deeper than initial overlap
///      plus h / 4, in both parts; or one copy of a part, shrunken by no more than that everywhere, stays off the
///      other part's surface all the time.
/// A part inside the void of another is outside its material. Accepted means proved. Refused means that a point
/// beyond the limit was found, or (`uncertain`) that the proof failed at a resolution of an eighth of the
/// penetration allowed, or within a fixed budget of tests; motions that keep to 0.4 times the limit are not
/// refused at ordinary corners.
///
/// The proof: let the corners of a triangle be displaced by at most e. If the displaced triangle sweeps a hull that
/// meets no triangle of the other part, and one of its points is outside it, no point of the triangle gets deeper
/// than e. For straight motion the swept hull is exact and a whole slide is one test per triangle; turning motion is
/// cut into intervals whose sagitta is covered by a margin.
///
/// Built once per assembly; const functions are safe to call from several threads.
class DISMANTLE_API Verifier {
 public:
  /// Idle threads of `executor`, which may be null, help to build it; it does not depend on that.
  Verifier(const Assembly& assembly, VerifyOptions options, Executor* executor = nullptr);
  ~Verifier();

  /// (b): the moving parts follow `path` (columns as `moving`) past `still`. Pairs that do not move
  /// relative to each other are not looked at.
  MotionCheck check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& still,
                           const Path& path) const;
  /// The same with so many threads, until told to stop.
  MotionCheck check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& still, const Path& path,
                           const RunContext& context) const;
  /// (b) for one part past another, for whoever has many such questions: true is proved, as by check_motion; false
  /// means refused, or not proved with a small share of the effort.
  bool passes(PartId moving, PartId still, const Pose& still_at, const std::vector<Pose>& way) const;
  /// (c): the hull of `group` is apart from the hull of `rest`, on all original vertices.
  bool apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;
  /// Way along the unit vector `direction`, at most `most` (where it is taken for granted), after which `group` is so;
  /// found by halving that so many times.
  double way_apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest,
                   const Eigen::Vector3d& direction, double most, int halvings) const;
  const VerifyOptions& options() const;
  std::size_t parts() const;
  /// Corners of the convex hull of a part, in its assembled frame.
  const std::vector<Eigen::Vector3d>& hull(PartId part) const;
  /// All pairs that are locked by their overlap, sorted by (a, b) as Assembly::overlaps. Found when built.
  const std::vector<Lock>& locks() const;
  /// Do the two, as they are assembled, hold each other? What is proved so holds wherever they were moved since, for
  /// no motion within the limits leads out of it. Fractions of a second up to a few, of very fine meshes up to a
  /// minute; nothing when told to stop.
  std::optional<Cage> caged(PartId a, PartId b, const RunContext& context = {}) const;
  /// The same for a large flat piece within `inside`; seconds up to ten, so it is not part of caged(). Nothing when
  /// told to stop.
  std::optional<Cage> caged_flat(PartId inside, PartId other, const RunContext& context) const;
  /// The same for any shape of the two, over boxes of relative poses, and for motions that cut in by less than that
  /// share (in (0, 1]) of max_penetration more than when assembled; with all of it much is not settled that is with
  /// half. Asked with a fixed effort: seconds up to half a minute.
  std::optional<Confinement> confined(PartId a, PartId b, const RunContext& context, double share = 0.5) const;
  /// Do these parts (>= 2, distinct), as they are assembled, hold each other in place? Told where they have little
  /// play: seconds for a handful of parts.
  std::optional<Interlock> interlocked(std::vector<PartId> parts, const RunContext& context) const;
  /// Are the moving parts shut in by the still ones, or (a single moving part) one of those by it? Found only when it
  /// can be proved within a fixed effort; a fraction of a second up to a few.
  std::optional<Enclosure> shut_in(const std::vector<PlacedPart>& moving, const std::vector<PlacedPart>& still) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A mesh made ready for measuring depths: worth keeping when one part meets several others. Immutable.
class DISMANTLE_API DepthBody {
 public:
  explicit DepthBody(const Mesh& mesh);
  ~DepthBody();
  DepthBody(DepthBody&&) noexcept;
  DepthBody& operator=(DepthBody&&) noexcept;
  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

/// How deep two parts penetrate each other, and where. Depth 0: they do not, and `point` means nothing.
struct Penetration {
  double depth = 0;                                 ///< >= 0, in the unit of the meshes
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< deepest surface point that was found, world
};

/// Depth in assembly units to which the surfaces of the two meshes penetrate each other: the largest
/// distance from a surface point of one, inside the other, to the other's surface, both ways.
/// Shell by shell as in the verifier's law. Exact to `tolerance` (> 0) from below; 0 when they only touch. Should the
/// search exceed its fixed budget, the deepest point found until then counts: still a lower bound, so an allowance
/// made of it is never too large. Poses place the meshes. @throws std::invalid_argument unless tolerance > 0.
DISMANTLE_API double penetration_depth(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                       double tolerance);
/// The same with the place of the deepest point.
DISMANTLE_API Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b,
                                              const Pose& pose_b, double tolerance);
DISMANTLE_API double penetration_depth(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                       double tolerance);

}  // namespace dismantle
