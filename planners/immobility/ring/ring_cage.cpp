#include "ring/ring_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dismantle/immobility/section.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

std::vector<InteriorCircle> circles_in(const Solid& solid, double depth, const RingParameters& params) {
  std::vector<InteriorCircle> candidates;
  if (!(0.5 * solid.box.size().minCoeff() > depth)) return candidates;
  const auto [center, axes] = symmetry_axes_of(solid);
  for (const Vec3& axis : axes) {
    double lo = 0, hi = 0, reach = 0;
    for (const Vec3& v : solid.mesh.vertices) {
      const double h = axis.dot(v - center);
      lo = std::min(lo, h);
      hi = std::max(hi, h);
      reach = std::max(reach, (v - center - h * axis).norm());
    }
    for (std::int64_t z = 0; z < params.heights; ++z) {
      const double share = (static_cast<double>(z) + 0.5) / static_cast<double>(params.heights);
      InteriorCircle circle{solid.frame * (center + (lo + (hi - lo) * share) * axis), solid.frame.q * axis, 0};
      for (std::int64_t r = params.radii; r > 0; --r) {
        circle.radius = reach * static_cast<double>(r) / static_cast<double>(params.radii);
        if (!samples_are_deep(solid, circle, depth)) continue;
        candidates.push_back(circle);
        break;
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const InteriorCircle& a, const InteriorCircle& b) { return a.radius > b.radius; });
  std::vector<InteriorCircle> circles;
  for (const InteriorCircle& circle : candidates) {
    if (circles.size() == static_cast<std::size_t>(params.max_rings)) break;
    if (is_deep(solid, circle, depth)) circles.push_back(circle);
  }
  return circles;
}

std::optional<RingCage> ring_cage(const InteriorCircle& circle, const Solid& around, double slack,
                                  const RingParameters& params, const RunContext& context) {
  if (!around.box.contains(around.frame.inverse() * circle.center)) return std::nullopt;  // a chamber is in the hull
  const Surface surface(around);
  const double middle = circle.axis.dot(circle.center);
  std::array<std::pair<double, Loop>, 2> narrowest;  // width and loop around the axis, below and above the circle
  for (auto& [width, loop] : narrowest) width = 2 * circle.radius - slack;
  for (const double offset : surface.offsets(circle.axis, static_cast<std::size_t>(params.max_sections))) {
    if (context.should_stop()) return std::nullopt;
    if (std::abs(offset - middle) < slack) continue;
    auto& best = narrowest[offset > middle ? 1 : 0];
    for (Loop& loop : surface.section({circle.axis, offset})) {
      if (!loop.around(circle.center)) continue;
      if (const double width = loop.diameter(); width < best.first) best = {width, std::move(loop)};
    }
  }
  std::vector<Loop> loops;
  for (auto& [width, loop] : narrowest)
    if (!loop.points.empty()) loops.push_back(std::move(loop));
  if (loops.empty()) return std::nullopt;
  const auto chamber = surface.closed_by(loops, circle.center);
  if (!chamber || chamber->inside(point_on(circle, 1)) != true) return std::nullopt;
  RingCage cage{circle, {}, 0};
  for (const Loop* loop : chamber->loops()) {
    cage.planes.push_back(loop->plane.offset);
    cage.opening = std::max(cage.opening, loop->diameter());
  }
  return cage;
}

}  // namespace dismantle::immobility
