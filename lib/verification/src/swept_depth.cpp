// Branch and bound over what the triangles sweep. A piece is settled when a displacement rule (patch.h) or the
// Lipschitz bound shows that it has nothing deeper than the deepest point found.
#include "swept_depth.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/geometry/solid.h"
#include "geometry_names.h"

namespace dismantle {
namespace verify {
namespace {

using Vec3 = Eigen::Vector3d;

/// A patch (frame of B) that moves by `by`: a share of the way, from `begin` on. A strip is a patch that rests: all
/// places on the way of a triangle that slides along itself.
struct Piece {
  Patch patch;
  Vec3 by = Vec3::Zero();
  double begin = 0, share = 1;
  bool strip = false;
  double bound = 0;         // of the depth in it
  std::uint64_t order = 0;  // among equal bounds the first one first
  Vec3 center() const { return patch.center() + 0.5 * by; }
  double radius() const { return patch.radius() + 0.5 * by.norm(); }
  bool operator<(const Piece& other) const { return bound != other.bound ? bound < other.bound : order > other.order; }
};

/// What both directions have found.
struct Deepest {
  double depth = 0;
  Vec3 point = Vec3::Zero();  // world, if it is deeper than the search began
};

/// The surface of A along its way through B.
class SweptDescent {
 public:
  using ToWorld = std::function<Vec3(const Vec3& point, double share)>;

  /// `place` maps A to the frame of B, where it moves by `along`; `world` tells where a point of A (frame of B) is in
  /// the world after that share of the way.
  SweptDescent(const Solid& a, const PlacedSolid& b, const Placement& place, const Vec3& along, ToWorld world,
               const SweptSearch& search, Deepest& deepest)
      : a_(a),
        b_(b.solid),
        field_(b.field),
        place_(place),
        along_(along),
        world_(std::move(world)),
        search_(search),
        deepest_(deepest) {
    if (!a_.bvh.nodes().empty()) collect(0);
  }

  /// Of the depth of what is left.
  double bound() const { return open_.empty() ? 0 : open_.top().bound; }
  double level() const { return deepest_.depth + resolution() * (1 - kRounding); }
  std::uint64_t pieces() const { return pieces_; }
  /// Settles or divides the piece with the largest bound.
  void step() {
    const Piece piece = open_.top();
    open_.pop();
    examine(piece);
  }

 private:
  double resolution() const { return search_.resolution(deepest_.depth); }

  void add(Piece piece, double bound) {
    piece.bound = bound;
    piece.order = pieces_++;
    open_.push(std::move(piece));
  }

  /// Adds what the triangles sweep whose boxes come near that of B.
  void collect(std::uint32_t id) {
    const TriangleBvh::Node& node = a_.bvh.nodes()[id];
    const Vec3 c = place_ * node.box.center(), h = place_.r.cwiseAbs() * (0.5 * node.box.size());
    Aabb swept{c - h, c + h};
    swept.extend(Aabb{swept.lo + along_, swept.hi + along_});
    if (!swept.overlaps(b_.box)) return;  // points outside the box of B have no depth
    if (node.count == 0) {
      collect(id + 1);
      collect(node.first);
      return;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) add_triangle(a_.bvh.order()[k]);
  }

  /// `x` in the frame of B, after that share of the way.
  Vec3 in_part_a(const Vec3& x, double share) const {
    return a_.frame * Vec3(place_.r.transpose() * (x - share * along_ - place_.t));
  }
  bool is_left_out(const Vec3& x, double share) const {
    return search_.left_out != nullptr &&
           (search_.left_out->contains(b_.frame * x) || search_.left_out->contains(in_part_a(x, share)));
  }

  /// All of it, in one of the two frames.
  bool is_left_out(const Piece& piece) const {
    if (search_.left_out == nullptr) return false;
    const auto all = [&](const auto& is_in) { return std::ranges::all_of(piece.patch.p, is_in); };
    return all([&](const Vec3& p) {
             return search_.left_out->contains(b_.frame * p) &&
                    search_.left_out->contains(b_.frame * Vec3(p + piece.by));
           }) ||
           (!piece.strip && all([&](const Vec3& p) { return search_.left_out->contains(in_part_a(p, piece.begin)); }));
  }

  /// A strip has points of the triangle at all instants: it cannot be left out in the frame of A.
  bool comes_near_region(const Corners& corners) const {
    if (search_.left_out == nullptr) return false;
    Aabb box;
    for (const Vec3& p : corners) box.extend(in_part_a(p, 0));
    return search_.left_out->overlaps(box);
  }

  void add_triangle(std::uint32_t t) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const Triangle& v = a_.mesh.triangles[t];
    Piece piece{{placed(place_, a_.bvh.corners(t)),
                 {place_.r * a_.inward[v[0]], place_.r * a_.inward[v[1]], place_.r * a_.inward[v[2]]},
                 t},
                along_};
    const Vec3 normal = place_.r * a_.normals[t];
    // So far off its own plane that the depth changes by no more than rounding.
    if (normal.isZero() || std::abs(normal.dot(along_)) > kRounding * (a_.box.size().norm() + along_.norm()) ||
        comes_near_region(piece.patch.p)) {
      add(std::move(piece), kInfinite);
      return;
    }
    const Corners corners = piece.patch.p;
    piece.strip = true;
    piece.by.setZero();
    piece.patch.inward = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    add(piece, kInfinite);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &p = corners[i], &q = corners[(i + 1) % 3];
      if ((q - p).cross(normal).dot(along_) <= 0) continue;  // the triangle moves away from this edge
      piece.patch.p = {p, q, q + along_};
      add(piece, kInfinite);
      piece.patch.p = {p, q + along_, p + along_};
      add(piece, kInfinite);
    }
  }

  void found(double depth, const Vec3& x, const Piece& piece, double share) {
    if (depth <= deepest_.depth) return;
    if (piece.strip) share = share_on_strip(x, piece.patch.triangle);
    if (is_left_out(x, share)) return;
    deepest_ = {depth, world_(x, share)};
  }

  /// When the triangle is at a point of its strip.
  double share_on_strip(const Vec3& x, std::uint32_t t) const {
    const Corners corners = placed(place_, a_.bvh.corners(t));
    const Vec3 normal = place_.r * a_.normals[t];
    double lo = 0, hi = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 out = (corners[(i + 1) % 3] - corners[i]).cross(normal);
      const double off = out.dot(x - corners[i]), speed = out.dot(along_);  // off <= share * speed
      if (speed > 0) lo = std::max(lo, off / speed);
      if (speed < 0) hi = std::min(hi, off / speed);
    }
    return std::clamp(0.5 * (lo + hi), 0.0, 1.0);
  }

  bool clear_outside(const Corners& begin, const Corners& end) const {
    const SweepResult seen = Sweep(begin, end, 0).test(b_.bvh);
    if (seen == SweepResult::unclear) return false;
    return seen == SweepResult::far || !b_.bvh.inside((begin[0] + begin[1] + begin[2]) / 3);
  }
  bool clear_outside(const Piece& piece, const Corners& moved) const {
    return clear_outside(moved, {moved[0] + piece.by, moved[1] + piece.by, moved[2] + piece.by});
  }

  /// Settles the piece or divides it.
  void examine(const Piece& piece) {
    if (is_left_out(piece)) return;
    const Patch& patch = piece.patch;
    const Corners& p = patch.p;
    const Corners last{p[0] + piece.by, p[1] + piece.by, p[2] + piece.by};
    if (Sweep(p, last, 0).test(b_.bvh) == SweepResult::far) return;
    const Vec3 center = piece.center();
    const Escape middle = escape_at(center, b_);
    found(middle.depth, center, piece, piece.begin + 0.5 * piece.share);
    const double bound = std::min(piece.bound, middle.depth + piece.radius());
    if (bound <= level()) return;
    if (!piece.strip && clear_outside(piece, moved_by_vertices(patch, level()))) return;
    const Vec3 normal = place_.r * a_.normals[patch.triangle];
    if (clear_outside(piece, moved_along(patch, -normal, level()))) return;
    // Corners of a prism may be displaced differently at its two ends.
    const Placement here;
    const Probe seen = probe(patch, here, b_);
    for (std::size_t i = 0; i < 3; ++i) found(seen.depth[i], p[i], piece, piece.begin);
    Probe seen_last = seen;
    Patch at_end = patch;
    at_end.p = last;
    if (!piece.strip) {
      seen_last = probe(at_end, here, b_);
      for (std::size_t i = 0; i < 3; ++i) found(seen_last.depth[i], last[i], piece, piece.begin + piece.share);
    }
    if (clear_outside(moved_by_probe(patch, seen, level()), moved_by_probe(at_end, seen_last, level()))) return;
    if (middle.depth > 0 && clear_outside(piece, moved_along(patch, middle.out, level()))) return;
    const Probe& deeper = seen_last.depth[static_cast<std::size_t>(seen_last.deepest)] >
                                  seen.depth[static_cast<std::size_t>(seen.deepest)]
                              ? seen_last
                              : seen;
    const auto deepest = static_cast<std::size_t>(deeper.deepest);
    if (deeper.depth[deepest] > 0 && clear_outside(piece, moved_along(patch, deeper.out[deepest], level()))) return;
    constexpr double kDivisions = 0.25;  // of a cell takes about as long as this piece so far
    field_.allow(kDivisions);
    Aabb box;
    for (const Corners* corners : {&p, &last})
      for (const Vec3& x : *corners) box.extend(x);
    if (field_.at_most(level(), box, 0.25 * resolution())) return;
    divide(piece, seen, seen_last, bound);
  }

  /// Where on the way to divide a prism, as a share of it: where a corner's way out changes, or in the middle. Of the
  /// least deep corners the way out may change anywhere.
  static std::optional<double> turn_on_way(const Vec3& by, const Probe& seen, const Probe& seen_last) {
    std::optional<double> best;
    double least = 0.7;  // as in ridge_on()
    for (std::size_t i = 0; i < 3; ++i) {
      const double agreement = seen.out[i].dot(seen_last.out[i]);
      if (agreement >= least || seen.depth[i] <= 0 || seen_last.depth[i] <= 0) continue;
      least = agreement;
      const double a = -by.dot(seen.out[i]), b = by.dot(seen_last.out[i]);
      const double t = a + b > 0 ? (seen_last.depth[i] - seen.depth[i] + b) / (a + b) : 0.5;
      best = std::abs(t - 0.5) < 0.4 ? t : 0.5;
    }
    return best;
  }

  /// As deep at both ends of the way.
  bool slides(const Probe& seen, const Probe& seen_last) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs(seen.depth[i] - seen_last.depth[i]) > resolution()) return false;
    return seen.depth[static_cast<std::size_t>(seen.deepest)] > 0;
  }

  void divide(const Piece& piece, const Probe& seen, const Probe& seen_last, double bound) {
    Piece part = piece;
    const auto turn = piece.strip ? std::nullopt : turn_on_way(piece.by, seen, seen_last);
    const bool last_is_deeper = seen_last.depth[static_cast<std::size_t>(seen_last.deepest)] >
                                seen.depth[static_cast<std::size_t>(seen.deepest)];
    const auto ridge = ridge_on(piece.patch, last_is_deeper ? seen_last : seen);
    // Where the way out changes on the way, a larger part of the surface is settled in one test on a short piece of it;
    // where nothing changes, a smaller one on all of it.
    const double edges = slides(seen, seen_last) ? 64 : ridge ? 2 : 1;
    const double longest = turn ? 0.5 * resolution() : edges * piece.patch.longest_edge();
    if (!piece.strip && piece.by.norm() > longest) {
      const double at = turn.value_or(0.5);
      part.by = at * piece.by;
      part.share = at * piece.share;
      add(part, bound);
      for (Vec3& corner : part.patch.p) corner += part.by;
      part.begin = piece.begin + part.share;
      part.by = (1 - at) * piece.by;
      part.share = (1 - at) * piece.share;
      add(part, bound);
      return;
    }
    const auto add_patch = [&](const Patch& patch) {
      part.patch = patch;
      add(part, bound);
    };
    if (ridge)
      for (const Patch& half : piece.patch.halves(ridge->edge, ridge->t)) add_patch(half);
    else
      for (const Patch& quarter : piece.patch.quarters()) add_patch(quarter);
  }

  const Solid& a_;
  const Solid& b_;
  DepthField& field_;
  const Placement place_;
  const Vec3 along_;
  const ToWorld world_;
  const SweptSearch& search_;
  Deepest& deepest_;
  std::uint64_t pieces_ = 0;
  std::priority_queue<Piece> open_;
};

}  // namespace
}  // namespace verify

SweptDepth swept_depth(const PlacedSolid& a, const Eigen::Vector3d& along, const PlacedSolid& b,
                       const SweptSearch& search, const RunContext& context) {
  using Vec3 = Eigen::Vector3d;
  const Pose place_a = a.part * a.solid.frame, place_b = b.part * b.solid.frame;
  verify::Deepest deepest{search.from};
  verify::SweptDescent there(
      a.solid, b, verify::Placement(place_b.inverse() * place_a), place_b.q.conjugate() * along,
      [&](const Vec3& x, double) { return place_b * x; }, search, deepest);
  verify::SweptDescent back(
      b.solid, a, verify::Placement(place_a.inverse() * place_b), place_a.q.conjugate() * -along,
      [&](const Vec3& x, double share) -> Vec3 { return place_a * x + share * along; }, search, deepest);
  std::uint64_t steps = 0;
  const auto ends = [&] {
    return deepest.depth >= search.enough || there.pieces() + back.pieces() > search.most_pieces ||
           (++steps % 64 == 0 && context.should_stop());
  };
  for (;;) {
    verify::SweptDescent& next = there.bound() >= back.bound() ? there : back;
    const bool settled = next.bound() <= next.level();
    if (settled || ends()) return {{deepest.depth, deepest.point}, settled};
    next.step();
  }
}

}  // namespace dismantle
