// Nuts for slots: a bar with a narrower neck and threaded holes through both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/mesh_measure.h"
#include "sizes.h"

namespace dismantle::fasteners {
namespace {

struct Cut {
  double material = 0;  // area without the holes
  std::vector<Loop> holes, outlines;
};

Cut cut_of(const Turned& turned, double share) {
  Cut out;
  for (const Loop& loop : turned.loops(turned.low() + share * turned.height())) {
    out.material += loop.hole ? -loop.area : loop.area;
    (loop.hole ? out.holes : out.outlines).push_back(loop);
  }
  return out;
}

/// Round holes at the same places and of the same size in all cuts.
std::vector<Loop> through_holes(const std::vector<Cut>& cuts) {
  std::vector<Loop> out;
  for (const Loop& hole : cuts.front().holes) {
    const bool all = std::all_of(cuts.begin() + 1, cuts.end(), [&](const Cut& cut) {
      return std::any_of(cut.holes.begin(), cut.holes.end(), [&](const Loop& other) {
        return (other.center - hole.center).norm() < 0.1 * hole.largest &&
               std::abs(other.area - hole.area) < 0.15 * hole.area;
      });
    });
    if (all && hole.largest < 1.3 * hole.smallest) out.push_back(hole);
  }
  return out;
}

}  // namespace

std::optional<Shape> slot_nut_of(const Mesh& mesh, double mm) {
  const Eigen::Vector3d box = oriented_box(mesh);
  if (!(box.x() > 0) || box.z() * mm > 60) return std::nullopt;
  std::vector<geometry::FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d a = geometry::area_vector(mesh, t);
    if (a.norm() > 0) faces.push_back({a.normalized(), a.norm() / 2});
  }
  faces = geometry::rounded_axes(faces);
  geometry::sort_by_area(faces, 3);
  for (const auto& face : faces) {
    const Turned turned(mesh, face.axis.normalized(), mesh.box().center());
    std::vector<Cut> cuts;
    for (const double share : {0.123, 0.314, 0.691, 0.877}) cuts.push_back(cut_of(turned, share));
    const std::vector<Loop> holes = through_holes(cuts);
    if (holes.empty() || holes.size() > 4) continue;
    // The neck is at one end and clearly narrower; each of its pieces has a hole. The bar is longer than wide.
    const bool neck_first = cuts.front().material < cuts.back().material;
    const Cut &narrow = neck_first ? cuts.front() : cuts.back(), &wide = neck_first ? cuts.back() : cuts.front();
    if (narrow.material > 0.75 * wide.material || narrow.outlines.size() > holes.size() || wide.outlines.size() != 1 ||
        wide.outlines.front().largest < 1.5 * wide.outlines.front().smallest)
      continue;
    const double diameter = 2 * std::sqrt(holes.front().area / std::numbers::pi), high = turned.height();
    const bool equal = std::all_of(holes.begin(), holes.end(), [&](const Loop& hole) {
      return std::abs(hole.area - holes.front().area) < 0.05 * holes.front().area;
    });
    if (!equal || high > 2.2 * diameter || high < 0.3 * diameter || wide.material < 0.5 * diameter * diameter) continue;
    // Drawn at the nominal diameter or with the hole for its thread, in a bar for that size.
    for (const Thread& t : threads()) {
      const double hole = diameter * mm;
      if (t.inch || (std::abs(hole - t.diameter) > 0.02 * t.diameter && std::abs(hole - t.minor()) > 0.03 * t.minor()))
        continue;
      const double width = std::min(box.y(), wide.outlines.front().smallest * 2) * mm;
      if (width > 4 * t.diameter || width < 1.3 * t.diameter) continue;
      Shape s;
      s.kind = Kind::nut;
      s.confidence = 0.6;
      s.size = t.name;
      s.axis = turned.axis();
      s.top = turned.at(turned.high());
      s.height = high;
      s.radius = box.z() / 2;
      s.shank_radius = diameter / 2;
      s.length = std::round(high * mm * 100) / 100;
      s.reason = fmt::format("bar with a neck for a slot, {} hole{} of {} mm", holes.size(),
                             holes.size() == 1 ? "" : "s", number(std::round(hole * 100) / 100));
      return s;
    }
  }
  return std::nullopt;
}

}  // namespace dismantle::fasteners
