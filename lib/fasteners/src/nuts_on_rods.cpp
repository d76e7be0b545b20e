// Nuts on threaded rods and shafts.
#include <algorithm>
#include <cmath>

#include "dismantle/fasteners/fastening.h"
#include "dismantle/geometry/box_index.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::fasteners {
namespace {

// A thread and its nut are drawn with any diameters between those of the crests and of the roots.
constexpr double kRoot = 0.8, kCrest = 1.25;  // of the radius of the nut's hole

bool is_nut(const Part& part) { return part.kind && part.kind->kind == "nut"; }
bool is_screw(const Part& part) { return part.kind && part.kind->kind == "screw"; }

/// The part fills the hole of the nut in its middle.
bool fills(const Shape& nut, const TriangleBvh& part) {
  const Eigen::Vector3d middle = nut.top - nut.height / 2 * nut.axis;
  if (!part.inside(middle)) return false;
  const ClosestPoint near = part.closest(middle, kCrest * nut.shank_radius);
  return near.distance > kRoot * nut.shank_radius && near.distance < kCrest * nut.shank_radius;
}

}  // namespace

std::vector<NutOnRod> nuts_on_rods(const Assembly& assembly, std::span<const Shape> shapes,
                                   std::span<const Fastening> fastenings, const SurfaceOf& surface) {
  std::vector<NutOnRod> found;
  const geometry::BoxIndex boxes = geometry::index_of_parts(assembly);
  for (const Part& nut : assembly.parts) {
    const Shape& shape = shapes[nut.id];
    if (!is_nut(nut) || nut.open || !(shape.shank_radius > 0) || !(shape.height > 0)) continue;
    const auto has = [&](const Fastening& f) { return std::ranges::find(f.into, nut.id) != f.into.end(); };
    if (std::ranges::any_of(fastenings, has)) continue;
    for (const std::size_t other : boxes.overlapping(boxes.box(nut.id))) {
      const Part& rod = assembly.parts[other];
      if (rod.id != nut.id && !rod.open && !is_screw(rod) && fills(shape, surface(rod.id)))
        found.push_back({nut.id, rod.id});
    }
  }
  return found;
}

}  // namespace dismantle::fasteners
