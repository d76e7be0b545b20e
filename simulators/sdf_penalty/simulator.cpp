#include "dismantle/errors.h"
#include "dismantle/plugin.h"
#include "world.h"

namespace dismantle::sdf_penalty {
namespace {

Capabilities offered() { return {.dynamics = true, .contacts = true, .distance = true, .max_moving = kMaxBodies}; }

class PenaltySimulator final : public Simulator {
 public:
  explicit PenaltySimulator(const Parameters& parameters) : parameters_(parameters) {}

  Capabilities capabilities() const noexcept override { return offered(); }

  std::shared_ptr<const Prepared> prepare(const Assembly& assembly, RunContext& context) override {
    auto prepared = std::make_shared<PreparedShapes>();
    sdf::ShapeOptions options;
    if (parameters_.distance == sdf::DistanceModel::grid)
      options.grid = {.cell = parameters_.cell, .cells_per_edge = static_cast<int>(parameters_.cells_per_edge)};
    options.points.spacing = parameters_.contact_spacing;
    prepared->placed = sdf::build_shapes(assembly, options, context);
    if (context.should_stop()) return prepared;
    // What overlaps when assembled may overlap as deep while it moves, pair by pair (end of B.1).
    // Round fits overlap by the facets of their meshes, more or less as they slide: give them half as much again.
    for (const InitialOverlap& o : assembly.overlaps)
      if (o.depth > 0) prepared->overlap[std::minmax(o.a, o.b)] = o.depth + std::min(0.5 * o.depth, kFacetAllowance);
    return prepared;
  }

  std::unique_ptr<World> world(const Assembly& assembly, const Prepared& prepared, const Cast& cast,
                               MotionSpace space) const override {
    const auto& shapes = dynamic_cast<const PreparedShapes&>(prepared);
    for (const auto* group : {&cast.moving, &cast.still})
      for (const PlacedPart& p : *group)
        if (p.part >= shapes.placed.size() || !shapes.placed[p.part].shape)
          throw InputError(
              p.part < assembly.parts.size() ? assembly.parts[p.part].name : "part " + std::to_string(p.part),
              "was not prepared (the preparation was interrupted)");
    return std::make_unique<PenaltyWorld>(shapes, cast, space, parameters_);
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::sdf_penalty

DISMANTLE_PLUGIN("dismantle.sdf_penalty", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::Simulator, dismantle::sdf_penalty::PenaltySimulator, dismantle::sdf_penalty::Parameters>(
      "sdf_penalty", "Rigid bodies under penalty contact on signed distance fields.",
      {.source = "Tian et al. 2022, section 4.1 and appendix A", .provides = dismantle::sdf_penalty::offered()});
}
