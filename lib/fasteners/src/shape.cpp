#include "dismantle/fasteners/shape.h"

#include "body.h"
#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::fasteners {

/// None: it is not turned about `axis`.
static std::optional<Body> body_of(const Mesh& mesh, const std::optional<TurnedAxis>& axis, double mm) {
  if (!axis || axis->share <= 0.55) return std::nullopt;
  std::size_t shells = 0;
  shells_of(mesh, shells);
  Body body{mesh, Turned(mesh, axis->axis, axis->point), {}, mm, axis->share, shells};
  constexpr int kSections = 96;
  // Not at round shares of the height, where faces often are.
  for (int i = 0; i < kSections; ++i)
    body.sections.push_back(body.turned.section(body.turned.low() + body.turned.height() * (i + 0.487) / kSections));
  return body;
}

Shape recognise_shape(const Mesh& mesh, double mm) {
  Shape other;
  other.reason = "no known shape";
  other.radius = mesh.box().size().norm() / 2;
  if (mesh.empty()) return other;
  const auto axis = turned_axis(mesh);
  if (const auto body = body_of(mesh, axis, mm))
    for (const auto& recognise : {nut_of, screw_of, ring_of, bar_of})
      if (auto shape = recognise(*body)) return *shape;
  for (const auto& recognise : {slot_nut_of, strand_of, flat_of})
    if (auto shape = recognise(mesh, mm)) return *shape;
  if (axis) other.roundness = roundness(mesh, axis->axis, axis->point);
  return other;
}

std::optional<Shape> shape_as(Kind kind, const Mesh& mesh, double mm) {
  if (mesh.empty() || (kind != Kind::screw && kind != Kind::nut)) return std::nullopt;
  const auto body = body_of(mesh, turned_axis(mesh), mm);
  if (!body) return std::nullopt;
  return kind == Kind::screw ? screw_form(*body) : nut_form(*body);
}

}  // namespace dismantle::fasteners
