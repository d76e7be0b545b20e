#include "dismantle/geometry/walls.h"

#include <algorithm>
#include <map>

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {
namespace {

/// Triangles of `a` near `b`, by sheet.
std::map<std::uint32_t, std::vector<std::uint32_t>> near_sheets(const Solid& a, const Solid& b, const Placement& place,
                                                                double reach) {
  const Eigen::Vector3d c = place.r.transpose() * (b.box.center() - place.t);
  const Eigen::Vector3d h = place.r.transpose().cwiseAbs() * (0.5 * b.box.size());
  Aabb near{c - h, c + h};
  near.inflate(reach);
  std::map<std::uint32_t, std::vector<std::uint32_t>> sheets;
  a.bvh.overlapping(near, [&](std::uint32_t t) { sheets[a.open ? a.shell_of[t] : 0].push_back(t); });
  return sheets;
}

/// One sheet next to another part.
class SheetAtRest {
 public:
  SheetAtRest(const std::vector<std::uint32_t>& triangles, const TriangleBvh& other, const Placement& place,
              const Displaced& displaced)
      : triangles_(triangles), other_(other), place_(place), displaced_(displaced) {}

  /// The hull of the sheet at two displacements meets nothing.
  bool clear(double side, double from, double to) {
    for (const std::uint32_t t : triangles_) {
      if (Sweep(placed(place_, displaced_(t, side, from)), placed(place_, displaced_(t, side, to)), 0).test(other_) !=
          SweepResult::unclear)
        continue;
      met_ = t;
      return false;
    }
    return true;
  }

  /// The first of `sides` that the shortest displacement reaches, and that stays clear; 0: none.
  double own_side(std::initializer_list<double> sides) {
    constexpr double kShortest = 1.0 / 1024;  // of the limit: below that, both sides are equally near
    for (double share = 0; share <= 1; share = std::max(2 * share, kShortest)) {
      bool any = false;
      for (const double side : sides) {
        if (!clear(side, share, share)) continue;
        any = true;
        if (clear(side, share, 1)) return side;
      }
      if (any) return 0;
    }
    return 0;
  }
  std::uint32_t met() const { return met_; }

 private:
  const std::vector<std::uint32_t>& triangles_;
  const TriangleBvh& other_;
  const Placement& place_;
  const Displaced& displaced_;
  std::uint32_t met_ = 0;
};

}  // namespace

std::optional<std::uint32_t> find_sides(const Solid& a, const Solid& b, const Placement& place,
                                        const Displaced& displaced, double reach, Lean lean, Sides& sides) {
  const bool confirm = !sides.empty();
  const double first = lean == Lean::back ? 1 : -1;
  if (!confirm) sides.assign(a.shell_begin.size() - 1, a.open ? first : 1);
  for (const auto& [sheet, triangles] : near_sheets(a, b, place, reach)) {
    SheetAtRest rest(triangles, b.bvh, place, displaced);
    if (!a.open) {
      if (!rest.clear(1, 1, 1)) return rest.met();
      continue;
    }
    const double wanted = confirm ? sides[sheet] : first, found = rest.own_side({wanted, -wanted});
    if (found == 0 || (confirm && found != wanted)) return rest.met();
    sides[sheet] = found;
  }
  return std::nullopt;
}

/// Beyond this, a displacement says nothing: a closed part is turned inside out by more than half of its least extent,
/// and a sheet leaves another part on its shorter way by half of the largest.
static double longest_displacement(const Solid& moved, const Solid& other) {
  return 0.5 * (moved.open ? other.box.size().norm() : moved.box.size().minCoeff());
}

bool apart_by(const Solid& a, const Solid& b, const Pose& a_in_b, double depth, Eigen::Vector3d& meets) {
  const auto meets_at = [&](const Solid& x, const Solid& y, const Placement& place) {
    const Displaced displaced = [&](std::uint32_t t, double side, double share) {
      Corners moved = x.bvh.corners(t);
      for (std::size_t k = 0; k < 3; ++k) moved[k] += side * share * depth * x.inward[x.mesh.triangles[t][k]];
      return moved;
    };
    Sides sides;
    return find_sides(x, y, place, displaced, depth, Lean::back, sides);
  };
  const Placement forward(a_in_b);
  const auto is_apart = [&](const Solid& x, const Solid& y, const Placement& place, std::optional<std::uint32_t>& met) {
    if (depth > longest_displacement(x, y)) return false;
    met = meets_at(x, y, place);
    return !met;
  };
  std::optional<std::uint32_t> first, second;
  if (is_apart(a, b, forward, first) || is_apart(b, a, Placement(a_in_b.inverse()), second)) return true;
  const auto center = [](const Solid& of, std::uint32_t t) {
    const Corners& c = of.bvh.corners(t);
    return Eigen::Vector3d((c[0] + c[1] + c[2]) / 3);
  };
  if (first)
    meets = forward * center(a, *first);
  else if (second)
    meets = center(b, *second);
  return false;
}

/// At rest, when the motion begins: chooses the sides; when it ends: confirms them. False: the check failed.
bool DirectedCheck::rests_at(double time) {
  const Placement place(motion_.at(time));
  const Displaced displaced = [&](std::uint32_t t, double side, double share) {
    const Patch patch = patch_of(t, side);
    return moved_by_vertices(patch, share * displacement(patch));
  };
  const auto met = find_sides(a_, b_, place, displaced, limits_.most(), lean_, sides_);
  if (!met) return true;
  return fail_at_wall(patch_of(*met, 1), time);
}

/// The displaced copy meets a triangle. Where the part is so thin that the copy is displaced by less than the limit,
/// that proves no cut.
bool DirectedCheck::fail_at_wall(const Patch& patch, double time) {
  const double reached = allowed(patch);
  const Answer answer = reached < limits_.most() ? Answer::uncertain : Answer::violated;
  return fail(answer, patch.center(), reached, patch.triangle, time);
}

/// The copy is fixed: a patch that meets a triangle at some instant ends the check.
bool DirectedCheck::settle_wall(const Interval& i, std::uint32_t id, List& later) {
  const Patch patch = patches_[id];
  const double most = allowed(patch), margin = i.bend.at(patch.center(), patch.radius() + most);
  const Corners moved = moved_by_vertices(patch, displacement(patch));
  if (worth_a_test(i, margin, patch.triangle)) {
    if (!budget_.spend_test()) return fail(Answer::exhausted, patch.center(), 0, patch.triangle, i.s0);
    bool far = false;
    if (clear(i, margin, moved, far)) {
      (*unclear_)[patch.triangle] *= 1.1;  // after a success, retry larger margins sooner
      return true;
    }
    if (margin > 0) (*unclear_)[patch.triangle] = margin;
  }
  const double s = middle(i);
  const Placement mid(motion_.at(s));
  const Corners there = placed(mid, moved), begin = placed(i.at0, moved), end = placed(i.at1, moved);
  if (!budget_.spend_test()) return fail(Answer::exhausted, patch.center(), 0, patch.triangle, i.s0);
  if (Sweep(there, there, 0).test(b_.bvh) == SweepResult::unclear) return fail_at_wall(patch, s);
  double travel = 0;
  for (std::size_t k = 0; k < 3; ++k) travel = std::max(travel, (end[k] - begin[k]).norm());
  // Far below the gap of parts that touch.
  if (i.s1 - i.s0 <= 1 && travel + margin < 1e-3 * (most - limits_.overlap))
    return fail(Answer::uncertain, patch.center(), most, patch.triangle, s);
  later.push_back(id);
  return true;
}

}  // namespace dismantle::geometry
