#include "certificates/body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"

namespace dismantle::certificates {
namespace {

bool is_closed(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> forward, backward;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      forward.emplace_back(t[k], t[(k + 1) % 3]);
      backward.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return forward == backward;
}

Body body_of(const geometry::Solid& solid) {
  Body body;
  for (const Vec3& v : solid.mesh.vertices) {
    body.vertices.push_back(solid.frame * v);
    body.box.extend(body.vertices.back());
  }
  body.triangles = solid.mesh.triangles;
  body.closed = is_closed(body.triangles);
  body.frame = solid.frame.q;
  return body;
}

}  // namespace

const std::vector<Body>& bodies_of(const SeparationQuery& query, PartId part) {
  return *query.memo.get<std::vector<Body>>("bodies of certificates", part, RunContext{}, [&] {
    const auto* solids = query.memo.get<std::vector<geometry::Solid>>("solids", part, RunContext{}, [&] {
      return std::optional(geometry::split_into_solids(*query.assembly.parts.at(part).mesh));
    });
    std::vector<Body> bodies;
    for (const geometry::Solid& solid : *solids) bodies.push_back(body_of(solid));
    return std::optional(std::move(bodies));
  });
}

double rounding_of(const SeparationQuery& query, PartId part) {
  return rounding_of(query.assembly.parts.at(part).mesh->box());
}

double rounding_of(const Aabb& box) {
  // About 5e5 times the rounding of one operation.
  return 1e-10 * std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
}

double allowed_depth(const SeparationQuery& query, PartId a, PartId b) {
  return query.assembly.initial_overlap(a, b) + query.margin();
}

double distance(const Vec3& p, const Corners& triangle) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 weights;  // barycentric, of the foot of the perpendicular, before normalisation
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = triangle[k], edge = triangle[(k + 1) % 3] - a, from = p - a;
    const double length = edge.squaredNorm();
    const double along = length > 0 ? std::clamp(from.dot(edge) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (from - along * edge).squaredNorm());
    weights[static_cast<Eigen::Index>((k + 2) % 3)] = normal.dot(edge.cross(from));
  }
  if (weights.minCoeff() > 0) {
    weights /= weights.sum();
    least = std::min(
        least, (weights[0] * triangle[0] + weights[1] * triangle[1] + weights[2] * triangle[2] - p).squaredNorm());
  }
  return std::sqrt(least);
}

double distance(const Vec3& p, const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < body.triangles.size(); ++t) least = std::min(least, distance(p, body.corners(t)));
  return least;
}

double solid_angle(const Vec3& p, const Corners& triangle) {
  const Vec3 u = triangle[0] - p, v = triangle[1] - p, w = triangle[2] - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  return 2 * std::atan2(u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
}

bool inside(const Vec3& p, const Body& body) {
  if (!body.box.contains(p)) return false;
  double turns = 0;
  for (std::size_t t = 0; t < body.triangles.size(); ++t)
    turns += solid_angle(p, body.corners(t)) / (4 * std::numbers::pi);
  return turns > 0.5 && std::abs(turns - std::round(turns)) < 1e-3;  // near the surface the sum is not an integer
}

double depth(const Vec3& p, const Body& body) { return inside(p, body) ? distance(p, body) : 0; }

const char* objection_to_outside_point(const SeparationQuery& query, PartId own, PartId other, const Body& obstacle,
                                       const Vec3& point) {
  const double limit = allowed_depth(query, own, other) + rounding_of(query, own);
  const std::vector<Body>& bodies = bodies_of(query, own);
  if (std::none_of(bodies.begin(), bodies.end(), [&](const Body& b) { return b.closed && depth(point, b) > limit; }))
    return "its point is not deep enough in its part";
  if (!obstacle.closed || inside(point, obstacle)) return "its point is not outside the other part";
  return nullptr;
}

}  // namespace dismantle::certificates
