#include "dismantle/fasteners/shape.h"

#include "body.h"
#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::fasteners {

Shape recognise_shape(const Mesh& mesh, double mm) {
  Shape other;
  other.reason = "no known shape";
  other.radius = mesh.box().size().norm() / 2;
  if (mesh.empty()) return other;
  const auto axis = turned_axis(mesh);
  if (axis && axis->share > 0.55) {
    std::size_t shells = 0;
    shells_of(mesh, shells);
    Body body{mesh, Turned(mesh, axis->axis, axis->point), {}, mm, axis->share, shells};
    constexpr int kSections = 96;
    // Not at round shares of the height, where faces often are.
    for (int i = 0; i < kSections; ++i)
      body.sections.push_back(body.turned.section(body.turned.low() + body.turned.height() * (i + 0.487) / kSections));
    for (const auto& recognise : {nut_of, screw_of, ring_of, bar_of})
      if (auto shape = recognise(body)) return *shape;
  }
  for (const auto& recognise : {slot_nut_of, strand_of, flat_of})
    if (auto shape = recognise(mesh, mm)) return *shape;
  return other;
}

}  // namespace dismantle::fasteners
