#include "dismantle/sdf/prepared_shapes.h"

#include "dismantle/errors.h"

namespace dismantle::sdf {

std::shared_ptr<PreparedShapes> prepare_shapes(const Assembly& assembly, const ShapeOptions& options, double tolerance,
                                               RunContext& context) {
  auto prepared = std::make_shared<PreparedShapes>();
  prepared->facet_allowance = options.facet_share * tolerance;
  prepared->tolerance = tolerance;
  prepared->contact_depth = options.contact_depth * tolerance;
  prepared->placed = build_shapes(assembly, options, context);
  if (context.should_stop()) return prepared;
  for (const InitialOverlap& o : assembly.overlaps)
    if (const double depth = o.allowed(); depth > 0)
      prepared->overlap[std::minmax(o.a, o.b)] = depth + std::min(0.5 * depth, prepared->facet_allowance);
  return prepared;
}

const PreparedShapes& shapes_of(const PreparedAssembly& prepared, const Assembly& assembly, const Scene& scene) {
  const auto& shapes = dynamic_cast<const PreparedShapes&>(prepared);
  for (const auto* group : {&scene.moving, &scene.fixed})
    for (const PlacedPart& p : *group)
      if (p.part >= shapes.placed.size() || !shapes.placed[p.part].shape)
        throw InputError(
            p.part < assembly.parts.size() ? assembly.parts[p.part].name : "part " + std::to_string(p.part),
            "was not prepared (the preparation was interrupted)");
  return shapes;
}

}  // namespace dismantle::sdf
