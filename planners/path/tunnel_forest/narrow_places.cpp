#include "narrow_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::tunnel_forest {
namespace {

Eigen::Vector3d normal_of(const std::array<Eigen::Vector3d, 3>& c) { return geometry::area_vector(c).normalized(); }

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
};

/// Does the ray enter the box before `limit`?
bool meets(const Aabb& box, const Eigen::Vector3d& from, const Eigen::Vector3d& inverse, double limit) {
  const Eigen::Array3d a = (box.lo - from).array() * inverse.array(), b = (box.hi - from).array() * inverse.array();
  return std::max(a.min(b).maxCoeff(), 0.0) <= std::min(a.max(b).minCoeff(), limit);
}

/// Distance along a ray to a triangle, infinite if it misses (Moeller and Trumbore 1997).
double ray_distance(const std::array<Eigen::Vector3d, 3>& c, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& along) {
  const double miss = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d e1 = c[1] - c[0], e2 = c[2] - c[0], p = along.cross(e2);
  const double det = e1.dot(p);
  if (std::abs(det) < 1e-14) return miss;
  const Eigen::Vector3d s = from - c[0], q = s.cross(e1);
  const double u = s.dot(p) / det, v = along.dot(q) / det;
  return u < 0 || v < 0 || u + v > 1 ? miss : e2.dot(q) / det;
}

Hit cast_ray(const TriangleBvh& bvh, const Eigen::Vector3d& from, const Eigen::Vector3d& along, double least) {
  Hit hit;
  const Eigen::Vector3d inverse = along.cwiseInverse();
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    const auto& node = bvh.nodes()[at];
    if (!meets(node.box, from, inverse, hit.distance)) continue;
    if (node.count == 0) {
      waiting.push_back(node.first);
      waiting.push_back(at + 1);
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const std::uint32_t triangle = bvh.order()[k];
      const double distance = ray_distance(bvh.corners(triangle), from, along);
      if (distance > least && distance < hit.distance) hit = {distance, triangle};
    }
  }
  return hit;
}

double median_width(const std::vector<NarrowPlace>& places) {
  std::vector<double> widths;
  for (const auto& p : places) widths.push_back(p.half_width);
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return *middle;
}

}  // namespace

Eigen::Quaterniond random_turn(Rng& rng) {
  const double u = rng.uniform(), a = 2 * std::numbers::pi * rng.uniform(), b = 2 * std::numbers::pi * rng.uniform();
  const double r = std::sqrt(1 - u), s = std::sqrt(u);
  return {s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b)};
}

NarrowPlaces find_narrow_places(const Mesh& mesh, std::size_t samples, Rng& rng) {
  NarrowPlaces found;
  if (mesh.triangles.empty()) return found;
  const TriangleBvh bvh(mesh);
  const double least = 1e-3 * mesh.box().size().maxCoeff();  // shorter chords are slivers of the mesh
  std::vector<double> area(mesh.triangles.size());
  double total = 0;
  for (std::uint32_t t = 0; t < area.size(); ++t) {
    const auto& c = bvh.corners(t);
    area[t] = total += 0.5 * geometry::area_vector(c).norm();
  }
  for (std::size_t k = 0; k < samples; ++k) {
    const auto place = std::upper_bound(area.begin(), area.end(), total * rng.uniform());
    const auto t = static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(place - area.begin(), static_cast<std::ptrdiff_t>(area.size()) - 1));
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& c = bvh.corners(t);
    const Eigen::Vector3d point = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), normal = normal_of(c);
    if (!normal.allFinite() || normal.squaredNorm() < 0.5) continue;
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d along = side * normal;
      const Hit hit = cast_ray(bvh, point, along, least);
      // Two surfaces face each other when their normals are opposite to within 60 degrees.
      if (!std::isfinite(hit.distance) || normal_of(bvh.corners(hit.triangle)).dot(normal) > -0.5) continue;
      (side > 0 ? found.gaps : found.bars).push_back({point + 0.5 * hit.distance * along, along, 0.5 * hit.distance});
    }
  }
  return found;
}

TunnelPoses::TunnelPoses(NarrowPlaces moving, NarrowPlaces fixed, double width)
    : moving_(std::move(moving)), fixed_(std::move(fixed)) {
  const auto keep_narrow = [width](std::vector<NarrowPlace>& gaps, const std::vector<NarrowPlace>& bars) {
    const double limit = bars.empty() ? 0 : width * median_width(bars);
    std::erase_if(gaps, [&](const NarrowPlace& g) { return g.half_width > limit; });
  };
  keep_narrow(moving_.gaps, fixed_.bars);
  keep_narrow(fixed_.gaps, moving_.bars);
  // Puzzles of two equal parts need the first kind, so it is drawn as often as the other two together.
  if (!moving_.gaps.empty() && !fixed_.gaps.empty()) kinds_.insert(kinds_.end(), 2, Kind::gap_in_gap);
  if (!moving_.bars.empty() && !fixed_.gaps.empty()) kinds_.push_back(Kind::bar_in_gap);
  if (!moving_.gaps.empty() && !fixed_.bars.empty()) kinds_.push_back(Kind::gap_on_bar);
}

TunnelPoses::Match TunnelPoses::draw(Rng& rng, bool turning) const {
  const auto any = [&](const std::vector<NarrowPlace>& places) -> const NarrowPlace& {
    return places[static_cast<std::size_t>(rng.below(places.size()))];
  };
  const Kind kind = kinds_[static_cast<std::size_t>(rng.below(kinds_.size()))];
  const NarrowPlace *m = nullptr, *s = nullptr;
  // The bar should fit into the gap or be a little wider; retraction then finds where it fits. If 20 draws find no
  // such pair, the last pair is used.
  for (int k = 0; k < 20; ++k) {
    m = &any(kind == Kind::bar_in_gap ? moving_.bars : moving_.gaps);
    s = &any(kind == Kind::gap_on_bar ? fixed_.bars : fixed_.gaps);
    if (kind == Kind::gap_in_gap) break;
    const NarrowPlace *gap = kind == Kind::bar_in_gap ? s : m, *bar = gap == s ? m : s;
    if (bar->half_width <= 1.05 * gap->half_width) break;
  }
  Match match;
  if (turning) match.displacement.q = random_turn(rng);
  if (turning && kind != Kind::gap_in_gap) {  // the chords are parallel, with a random rotation about them
    const Eigen::Vector3d axis = match.displacement.q * m->axis;
    match.displacement.q = (Eigen::Quaterniond::FromTwoVectors(axis, s->axis) * match.displacement.q).normalized();
  }
  match.on_moving = m->middle;
  match.on_fixed = s->middle;
  match.displacement.t = s->middle - match.displacement.q * m->middle;
  match.reach = 0.75 * (m->half_width + s->half_width);
  return match;
}

}  // namespace dismantle::tunnel_forest
