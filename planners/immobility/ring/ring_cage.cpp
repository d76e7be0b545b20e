#include "ring/ring_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "dismantle/immobility/section.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr std::size_t kSections = 150;  // of the solid around it
constexpr double kSlack = 1e-6;         // assembly units: an opening is smaller by more than that

}  // namespace

std::vector<InnerRing> rings_in(const Solid& solid, double depth, std::size_t most) {
  std::vector<InnerRing> candidates;
  if (!(0.5 * solid.box.size().minCoeff() > depth)) return candidates;
  const auto [center, axes] = round_axes_of(solid);
  for (const Vec3& axis : axes) {
    double lo = 0, hi = 0, reach = 0;
    for (const Vec3& v : solid.mesh.vertices) {
      const double h = axis.dot(v - center);
      lo = std::min(lo, h);
      hi = std::max(hi, h);
      reach = std::max(reach, (v - center - h * axis).norm());
    }
    for (int z = 0; z < kRingHeights; ++z) {
      InnerRing ring{solid.frame * (center + (lo + (hi - lo) * (z + 0.5) / kRingHeights) * axis), solid.frame.q * axis,
                     0};
      for (int r = kRingRadii; r > 0; --r) {
        ring.radius = reach * r / kRingRadii;
        if (!looks_deep(solid, ring, depth)) continue;
        candidates.push_back(ring);
        break;
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const InnerRing& a, const InnerRing& b) { return a.radius > b.radius; });
  std::vector<InnerRing> rings;
  for (const InnerRing& ring : candidates) {
    if (rings.size() == most) break;
    if (is_deep(solid, ring, depth, 0, 2 * pi, kArcHalvings)) rings.push_back(ring);
  }
  return rings;
}

std::optional<RingCage> ring_cage(const InnerRing& ring, const Solid& around, const RunContext& context) {
  if (!around.box.contains(around.frame.inverse() * ring.center)) return std::nullopt;  // a chamber is in the hull
  const Surface surface(around);
  const double middle = ring.axis.dot(ring.center);
  std::array<std::pair<double, Loop>, 2> nearest;  // the smallest around the axis below and above the ring: width, loop
  for (auto& [width, loop] : nearest) width = 2 * ring.radius - kSlack;
  for (const double offset : surface.offsets(ring.axis, kSections)) {
    if (context.should_stop()) return std::nullopt;
    if (std::abs(offset - middle) < 1e-9) continue;
    auto& best = nearest[offset > middle ? 1 : 0];
    for (Loop& loop : surface.section({ring.axis, offset})) {
      if (!loop.around(ring.center)) continue;
      if (const double width = loop.diameter(); width < best.first) best = {width, std::move(loop)};
    }
  }
  std::vector<Loop> loops;
  for (auto& [width, loop] : nearest)
    if (!loop.points.empty()) loops.push_back(std::move(loop));
  if (loops.empty()) return std::nullopt;
  const auto chamber = surface.closed_by(loops, ring.center);
  if (!chamber || chamber->inside(point_on(ring, 1)) != true) return std::nullopt;
  RingCage cage{ring, 0};
  for (const Loop* loop : chamber->loops()) cage.opening = std::max(cage.opening, loop->diameter());
  return cage;
}

}  // namespace dismantle::immobility
