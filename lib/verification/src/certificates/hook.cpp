/// hook: a bar of the first part goes through a hole of the second part, between two bends that cannot pass the hole.
///
/// Keep the second part fixed. A line leads through the bar from the corner of one bend to the corner of the other. It
/// is deeper in the first part than the pair may penetrate, so the surface of the second part never meets it. Nor does
/// the border of a flat disc across the hole, which is a curve on that surface. At first the line crosses the disc an
/// odd number of times. If the parts were apart it would not cross the disc. The parity changes only when an end of the
/// line crosses the disc. Suppose that the corner of a bend is on the disc. The surface of the second part keeps a
/// distance from each point of a leg, so a leg cannot point in every direction. Squares cover all positions on the
/// disc, and for each square cells cover all directions. No two of the remaining directions differ by as much as the
/// legs do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/circle.h"
#include "certificates/section.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::certificates {
namespace {

/// Two straight legs from one corner. Other surfaces stay further than `keep[k]` from point k * step of either leg.
struct Bend {
  Vec3 corner;
  double apart = 0;  ///< distance between unit vectors along the legs
  double step = 0;
  std::vector<double> keep;  ///< from k = 0 on
};

/// Unit vectors through a square on a face of the cube [-1, 1]^3; all are within `radius` of `center`.
struct Directions {
  int axis = 0;
  Vec3 on_face = Vec3::UnitX();  ///< middle of the square
  double half = 1;
  int level = 0;

  Vec3 center() const { return on_face.normalized(); }
  double radius() const { return std::sqrt(2.0) * half; }  // projection to the unit sphere does not increase distances
  Directions quarter(int k) const {
    Directions d = *this;
    d.half = 0.5 * half;
    d.level = level + 1;
    d.on_face[(axis + 1) % 3] += k & 1 ? d.half : -d.half;
    d.on_face[(axis + 2) % 3] += k & 2 ? d.half : -d.half;
    return d;
  }
};

class Passage {
 public:
  Passage(const Body& around, const Plane& plane, const Loop& loop, const Bend& bend, const RunContext& context)
      : surface_({around.vertices, around.triangles}),
        plane_(plane),
        loop_(loop),
        bend_(bend),
        context_(context),
        rounding_(rounding_of(around.box)),
        e_(plane.normal.unitOrthogonal()),
        f_(plane.normal.cross(e_)) {}

  /// True if the corner is proved never to be on the disc.
  bool closed() {
    Aabb box;
    for (const Vec3& p : loop_.points) box.extend(Vec3(e_.dot(p), f_.dot(p), 0));
    std::vector<Directions> all;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) all.push_back({axis, side * Vec3::Unit(axis), 1, 0});
    const Vec3 middle = box.center();
    return closed(plane_.offset * plane_.normal + middle.x() * e_ + middle.y() * f_, 0.5 * box.size().maxCoeff(), all);
  }

 private:
  static constexpr std::uint64_t kMostQueries =
      30'000'000;  // distance queries; a count, so that answers do not depend on the machine

  bool too_near(const Vec3& p, double keep) {
    if (!(keep > rounding_)) return false;
    ++queries_;
    return surface_.closest(p, keep).distance < keep - rounding_;
  }

  /// True if no leg can point in one of the directions while the corner is in the square about `at`.
  bool blocked(const Vec3& at, double around, const Directions& d) {
    const Vec3 along = d.center();
    for (std::size_t k = bend_.keep.size(); k-- > 1;) {
      const double far = static_cast<double>(k) * bend_.step;
      if (too_near(at + far * along, bend_.keep[k] - around - far * d.radius())) return true;
    }
    return false;
  }

  /// True if the corner is proved not to be in the square about `at` (`half`: of its edge). `before`: directions that
  /// the enclosing square left.
  bool closed(const Vec3& at, double half, const std::vector<Directions>& before) {
    const double around = std::sqrt(2.0) * half;
    if (loop_.turns(at, plane_) == 0 && loop_.distance(at) > around + rounding_) return true;  // beside the disc
    if (too_near(at, bend_.keep[0] - around)) return true;
    const bool last = 64 * half < bend_.keep[0];  // the smallest squares have edges of less than keep[0] / 32
    std::vector<Directions> left;
    for (const Directions& d : before) leave(at, around, d, last, left);
    const auto differ = [&](const Directions& a, const Directions& b) {
      return std::abs((a.center() - b.center()).norm() - bend_.apart) <= a.radius() + b.radius();
    };
    const bool any = std::any_of(left.begin(), left.end(), [&](const Directions& a) {
      return std::any_of(left.begin(), left.end(), [&](const Directions& b) { return differ(a, b); });
    });
    if (!any) return true;
    if (last || queries_ > kMostQueries || context_.should_stop()) return false;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        if (!closed(at + half * (x * e_ + y * f_), 0.5 * half, left)) return false;
    return true;
  }

  /// Divides directions as finely as positions; to the finest level in the last squares.
  void leave(const Vec3& at, double around, const Directions& d, bool last, std::vector<Directions>& left) {
    if (queries_ > kMostQueries || blocked(at, around, d)) return;
    const bool fine = d.radius() * bend_.step * static_cast<double>(bend_.keep.size()) < (last ? 0.0 : 2 * around);
    if (fine || d.level == 7) {  // 0.7 degrees: bends are 50 degrees or more
      left.push_back(d);
      return;
    }
    for (int k = 0; k < 4; ++k) leave(at, around, d.quarter(k), last, left);
  }

  TriangleBvh surface_;
  const Plane& plane_;
  const Loop& loop_;
  const Bend& bend_;
  const RunContext& context_;
  double rounding_;
  Vec3 e_, f_;
  std::uint64_t queries_ = 0;
};

std::vector<Vec3> points_of(const Certificate& certificate, const char* name) {
  const auto& n = certificate.numbers.at(name);
  std::vector<Vec3> points;
  for (std::size_t k = 0; k + 3 <= n.size(); k += 3) points.emplace_back(n[k], n[k + 1], n[k + 2]);
  return points;
}

/// nullopt where a leg is not deep enough.
std::optional<Bend> bend_of(const Vec3& corner, const std::vector<Vec3>& legs, double step, double count,
                            const Body& bar, double allowed) {
  if (!(step > 0) || !(count >= 2 && count <= 1000)) return std::nullopt;
  Bend bend{corner, (legs[0].normalized() - legs[1].normalized()).norm(), step, {}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& leg : legs)
      least = std::min(least, depth(corner + static_cast<double>(k) * step * leg.normalized(), bar) - allowed);
    if (!(least > 0)) return std::nullopt;
    bend.keep.push_back(least);
  }
  return bend;
}

std::string objection_to_hole(const Certificate& certificate, const std::vector<Vec3>& path,
                              const std::vector<Bend>& bends, const Body& around, const RunContext& context) {
  const Vec3 hole = points_of(certificate, "hole")[0], normal = points_of(certificate, "normal")[0].normalized();
  const Plane plane{normal, normal.dot(hole)};
  std::optional<Loop> border;
  for (Loop& loop : section(around, neighbours_of(around), plane))
    if (loop.turns(hole, plane) != 0 && (!border || loop.diameter() < border->diameter())) border = std::move(loop);
  if (!border) return "there is no hole around its point";
  if (const double width = border->diameter();
      !(width <= certificate.numbers.at("width").front() + rounding_of(around.box)))
    return fmt::format("its hole is {:.6g} wide", width);
  int crossings = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
    if (plane.above(path[k]) != plane.above(path[k + 1]) &&
        border->turns(plane.cut(path[k], path[k + 1]), plane) % 2 != 0)
      ++crossings;
  if (crossings % 2 == 0) return "its line does not go through the hole";
  for (const Bend& bend : bends)
    if (!Passage(around, plane, *border, bend, context).closed())
      return context.should_stop() ? "the check was stopped" : "a bend of it may pass the hole";
  return {};
}

}  // namespace

std::string objection_to_hook(const Certificate& certificate, const SeparationQuery& query, const RunContext& context) {
  const PartId inner = certificate.parts[0], outer = certificate.parts[1];
  const double allowed = allowed_depth(query, inner, outer) + rounding_of(query, inner);
  const std::vector<Vec3> path = points_of(certificate, "path");
  if (path.size() < 2 || certificate.numbers.at("path").size() % 3 != 0) return "its line is not made of points";
  const std::array<std::vector<Vec3>, 2> legs = {points_of(certificate, "first_legs"),
                                                 points_of(certificate, "second_legs")};
  const auto &steps = certificate.numbers.at("steps"), &counts = certificate.numbers.at("points");
  std::string objection = "its bar is not deep enough in the first part";
  for (const Body& bar : bodies_of(query, inner)) {
    std::vector<Bend> bends;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 corner = points_of(certificate, side == 0 ? "first_bend" : "second_bend")[0];
      if ((corner - (side == 0 ? path.front() : path.back())).norm() > rounding_of(bar.box))
        return "its line does not end in its bends";
      if (auto bend = bend_of(corner, legs[side], steps[side], counts[side], bar, allowed)) bends.push_back(*bend);
    }
    if (bends.size() < 2) continue;
    bool deep = true;
    for (std::size_t k = 0; k + 1 < path.size() && deep; ++k) {
      if (context.should_stop()) return "the check was stopped";
      deep = lies_deep(path[k], path[k + 1], bar, allowed);
    }
    if (!deep) continue;
    for (const Body& around : bodies_of(query, outer)) {
      objection = objection_to_hole(certificate, path, bends, around, context);
      if (objection.empty()) return {};
    }
  }
  return objection;
}

}  // namespace dismantle::certificates
