#include "dismantle/geometry/directed_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

Aabb box_under(const Placement& m, const Aabb& box) {
  const Vec3 c = m * box.center(), h = m.r.cwiseAbs() * (0.5 * box.size());
  return {c - h, c + h};
}

/// Corners moved by the vertex rule, but across `motion`: the way out of a surface that is as deep all along a slide. A
/// corner stays where that has no direction. It saves two thirds of the time for a thread that slides out of its bore.
Corners moved_across(const Patch& patch, const Vec3& motion, double depth) {
  constexpr double kLeast = 0.1;  // of a corner's displacement: less has no sure direction
  Corners moved = patch.p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 across = patch.inward[i] - patch.inward[i].dot(motion) * motion;
    const double length = patch.inward[i].norm();
    if (across.norm() > kLeast * length) moved[i] += depth * length * across.normalized();
  }
  return moved;
}

}  // namespace

DirectedCheck::DirectedCheck(const Solid& a, const Solid& b, const RelativeMotion& motion, const Limits& limits,
                             Budget& budget, Lean lean)
    : a_(a),
      b_(b),
      motion_(motion),
      limits_(limits),
      budget_(budget),
      patch_of_(a.mesh.triangles.size(), kNoIndex),
      unclear_(std::make_shared<std::vector<double>>(a.mesh.triangles.size(), std::numeric_limits<double>::infinity())),
      walls_(a.open || b.open),
      lean_(lean) {}

Finding DirectedCheck::run() {
  if (walls_ && !rests_at(0)) return finding_;
  std::size_t done = 0;
  const auto up_to = [&](std::size_t instant) {
    return instant == done || descend(static_cast<double>(done), static_cast<double>(instant));
  };
  bool holds = true;
  for (const Winding& w : windings(motion_, limits_.cells_from() / 1000)) {
    holds = up_to(w.begin) && wind(w);
    if (!holds) return finding_;
    done = w.end;
  }
  if (!up_to(motion_.segments())) return finding_;
  if (walls_)
    rests_at(static_cast<double>(motion_.segments()));
  else
    sides();
  return finding_;
}

DirectedCheck::Interval DirectedCheck::interval(double s0, double s1) const {
  return {
      s0, s1, motion_.deviation(s0, s1), Placement(motion_.at(s0)), Placement(motion_.at(s1)), motion_.bend(s0, s1)};
}

double DirectedCheck::middle(const Interval& i) const {
  const double m = 0.5 * (i.s0 + i.s1);
  return i.s1 - i.s0 > 1 ? std::floor(m) : m;
}

bool DirectedCheck::fail(Answer answer, const Vec3& point, double depth, std::uint32_t triangle, double time) {
  finding_ = {answer, point, false, depth, a_.thickness[triangle], time};
  return false;
}

std::uint32_t DirectedCheck::add(const Patch& patch) {
  patches_.push_back(patch);
  return static_cast<std::uint32_t>(patches_.size() - 1);
}

Patch DirectedCheck::patch_of(std::uint32_t triangle, double side) const {
  Patch patch{a_.bvh.corners(triangle), {}, triangle};
  const double most = allowed(patch);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t v = a_.mesh.triangles[triangle][c];
    // Scaled so that a vertex has the same displacement in all its triangles.
    patch.inward[c] = (side * limits_.at(a_.vertex_thickness[v]) / most) * a_.inward[v];
  }
  return patch;
}

/// Collects the triangles of A whose boxes come near B's box in the interval.
void DirectedCheck::collect(const Interval& i, std::uint32_t id, List& list) {
  const TriangleBvh::Node& node = a_.bvh.nodes()[id];
  Aabb swept = box_under(i.at0, node.box);
  swept.extend(box_under(i.at1, node.box));
  swept.inflate(i.margin + limits_.most());
  if (!swept.overlaps(b_.box)) return;
  if (node.count == 0) {
    collect(i, id + 1, list);
    collect(i, node.first, list);
    return;
  }
  for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
    const std::uint32_t t = a_.bvh.order()[k];
    if (patch_of_[t] == kNoIndex) patch_of_[t] = add(patch_of(t, walls_ ? sides_[a_.shell_of[t]] : 1));
    list.push_back(patch_of_[t]);
  }
}

/// Divides curved paths into roughly straight pieces before it collects triangles.
bool DirectedCheck::descend(double s0, double s1) {
  const Interval i = interval(s0, s1);
  if (s1 - s0 > 1 && i.margin > 0.05 * a_.box.size().maxCoeff()) {
    const double m = middle(i);
    return descend(s0, m) && descend(m, s1);
  }
  List list;
  if (!a_.bvh.nodes().empty()) collect(i, 0, list);
  return process(i, std::move(list), true);
}

bool DirectedCheck::process(const Interval& i, List list, bool vertex_rule) {
  List later;
  if (!settle_all(i, std::move(list), vertex_rule, later)) return false;
  if (later.empty()) return true;
  const double m = middle(i);
  // So short that halving it changes nothing: what is still open is not decided, and the recursion ends.
  if (!(i.s1 - i.s0 > 1e-12 * std::max(1.0, i.s1))) {
    const Patch& open = patches_[later.front()];
    return fail(Answer::uncertain, open.center(), 0, open.triangle, i.s0);
  }
  return process(interval(i.s0, m), later, vertex_rule) && process(interval(m, i.s1), std::move(later), vertex_rule);
}

bool DirectedCheck::settle_all(const Interval& i, List list, bool vertex_rule, List& later) {
  return has_help() ? settle_shared(i, list, vertex_rule, later)
                    : settle_in_turn(i, std::move(list), vertex_rule, later);
}

bool DirectedCheck::settle_in_turn(const Interval& i, List list, bool vertex_rule, List& later) {
  while (!list.empty()) {
    const std::uint32_t id = list.back();
    list.pop_back();
    if (!settle(i, id, vertex_rule, list, later)) return false;
  }
  return true;
}

bool DirectedCheck::clear(const Interval& i, double margin, const Corners& moved, bool& far) {
  const SweepResult seen = Sweep(placed(i.at0, moved), placed(i.at1, moved), margin).test(b_.bvh);
  far = seen == SweepResult::far;
  return seen != SweepResult::unclear;
}

/// Along a close fit a triangle fails repeatedly at the same margin: skip tests that failed recently, except in very
/// short intervals, which are the last resort.
bool DirectedCheck::worth_a_test(const Interval& i, double margin, std::uint32_t triangle) const {
  return i.s1 - i.s0 <= 1.0 / 64 || margin < (*unclear_)[triangle];
}

bool DirectedCheck::outside(const Placement& place, const Corners& moved) const {
  return !b_.bvh.inside(place * ((moved[0] + moved[1] + moved[2]) / 3));
}

/// Certifies a patch for an interval, or adds it (or its pieces) to one of the lists. False: the check failed.
bool DirectedCheck::settle(const Interval& i, std::uint32_t id, bool vertex_rule, List& same, List& later) {
  if (walls_) return settle_wall(i, id, later);
  const Patch patch = patches_[id];
  const double most = allowed(patch), e = displacement(patch), leeway = most - limits_.overlap;
  const double margin = i.bend.at(patch.center(), patch.radius() + most);
  if (exempt(i, margin, patch)) {
    by_shrunken_copy_ = false;
    return true;
  }
  const bool bent = margin > 0.5 * leeway;
  bool far = false;
  if (!bent || (vertex_rule && worth_a_test(i, margin, patch.triangle))) {
    if (!budget_.spend_test()) return fail(Answer::exhausted, patch.center(), 0, patch.triangle, i.s0);
    if (vertex_rule && clear(i, margin, moved_by_vertices(patch, e), far)) {
      if (!far) pieces_.push_back({id, i.s0, i.s1});
      (*unclear_)[patch.triangle] *= 1.1;  // after a success, retry larger margins sooner
      return true;
    }
    if (bent) (*unclear_)[patch.triangle] = margin;  // no other rule applies to bent motion
  }
  if (meets_exempt_only(i, margin, patch)) {
    by_shrunken_copy_ = false;
    return true;
  }
  // The border of the exempt box is fixed to the patch: no interval is short enough for a patch across it.
  if (const std::optional<Ridge> border = exempt_border(patch)) {
    if (budget_.patches_left < 2) return fail(Answer::exhausted, patch.center(), 0, patch.triangle, i.s0);
    budget_.patches_left -= 2;
    for (Patch half : patch.halves(border->edge, border->t)) {
      half.halved = patch.halved;
      same.push_back(add(half));
    }
    return true;
  }
  if (bent) {  // too bent to be treated as straight
    later.push_back(id);
    return true;
  }
  const double s = 0.5 * (i.s0 + i.s1);
  const Placement mid(motion_.at(s));
  const Corners begin = placed(i.at0, patch.p), end = placed(i.at1, patch.p);
  double travel = 0;
  for (std::size_t k = 0; k < 3; ++k) travel = std::max(travel, (end[k] - begin[k]).norm());
  const Escape center = escape_at(mid * patch.center(), b_);
  const double depth = center.depth;
  const auto violates = [&](const Vec3& point, double at_depth, const Placement& place) {
    return at_depth > most && !limits_.exempts(a_, point, b_, place * point);
  };
  if (violates(patch.center(), depth, mid)) return fail(Answer::violated, patch.center(), depth, patch.triangle, s);
  const double reach = patch.radius() + 0.5 * travel + 2 * margin;
  if (depth + reach <= most) {  // depth changes at most as fast as the point moves
    by_shrunken_copy_ = false;
    return true;
  }
  const auto leaves = [&](const Corners& moved) {
    if (!clear(i, margin, moved, far) || !(far || outside(i.at0, moved))) return false;
    by_shrunken_copy_ = false;
    return true;
  };
  if (leaves(moved_along(patch, -a_.normals[patch.triangle], e))) return true;
  if (const Vec3 by = mid.r.transpose() * (end[0] - begin[0]); limits_.overlap > 0 && by.norm() > most)
    if (leaves(moved_across(patch, by.normalized(), e))) return true;
  // First the shortest way out at mid-interval, then at the time when each corner is deepest.
  Probe seen = probe(patch, mid, b_);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto deepest = static_cast<std::size_t>(seen.deepest);
    if (attempt == 0 && violates(patch.p[deepest], seen.depth[deepest], mid))
      return fail(Answer::violated, patch.p[deepest], seen.depth[deepest], patch.triangle, s);
    if (leaves(moved_by_probe(patch, seen, e))) return true;
    if (attempt > 0) break;
    for (const auto& [place, time] : {std::pair(i.at0, i.s0), std::pair(i.at1, i.s1)}) {
      const Probe at_end = probe(patch, place, b_);
      const auto corner = static_cast<std::size_t>(at_end.deepest);
      if (violates(patch.p[corner], at_end.depth[corner], place))
        return fail(Answer::violated, patch.p[corner], at_end.depth[corner], patch.triangle, time);
      seen.deepen(at_end);
    }
  }
  if (depth > 0 && leaves(moved_along(patch, mid.r.transpose() * center.out, e))) return true;
  // Points on one side of a ridge share a way out: that of the deepest corner.
  const auto deepest = static_cast<std::size_t>(seen.deepest);
  if (seen.depth[deepest] > 0 && leaves(moved_along(patch, seen.out[deepest], e))) return true;
  if (reach < budget_.resolution * leeway) return fail(Answer::uncertain, patch.center(), depth, patch.triangle, s);
  // A ridge often lies along the motion: cut the patch there before halving the interval.
  const auto ridge = ridge_on(patch, seen);
  const bool shorter = i.s1 - i.s0 > 1 || (!ridge && travel + 2 * margin > 0.3 * patch.longest_edge());
  if (shorter) {
    later.push_back(id);
    return true;
  }
  if (budget_.patches_left < 4) return fail(Answer::exhausted, patch.center(), depth, patch.triangle, s);
  budget_.patches_left -= 4;
  if (ridge) {
    for (const Patch& half : patch.halves(ridge->edge, ridge->t)) same.push_back(add(half));
  } else {
    for (const Patch& quarter : patch.quarters()) same.push_back(add(quarter));
  }
  return true;
}

/// The vertex rule keeps patches off the surface of B; this proves that they are on its outer side.
bool DirectedCheck::sides() {
  if (by_shrunken_copy_) {
    // Each shell of the shrunken copy is always off the surface: one corner at one time decides its side.
    const Placement start(motion_.at(0));
    bool all_outside = true;
    for (std::size_t k = 0; k + 1 < a_.shell_begin.size() && all_outside; ++k) {
      const std::uint32_t v = a_.shell_vertices[a_.shell_begin[k]];
      const Vec3 x = a_.mesh.vertices[v] + limits_.at(a_.vertex_thickness[v]) * (1 - kRounding) * a_.inward[v];
      all_outside = !b_.bvh.inside(start * x);
    }
    if (all_outside) return true;
  }
  by_shrunken_copy_ = false;
  const std::vector<Piece> pieces = std::move(pieces_);
  pieces_.clear();
  for (const Piece& piece : pieces) {
    const Patch& patch = patches_[piece.patch];
    if (outside(Placement(motion_.at(piece.s0)), moved_by_vertices(patch, displacement(patch)))) continue;
    if (!process(interval(piece.s0, piece.s1), {piece.patch}, false)) return false;
  }
  return true;
}

}  // namespace dismantle::geometry
