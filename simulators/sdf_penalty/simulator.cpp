#include "dismantle/plugin.h"
#include "world.h"

namespace dismantle::sdf_penalty {
namespace {

Capabilities offered() { return {.dynamics = true, .contacts = true, .distance = true, .max_moving = sdf::kMaxBodies}; }

class PenaltySimulator final : public Simulator {
 public:
  explicit PenaltySimulator(const Parameters& parameters) : parameters_(parameters) {}

  Capabilities capabilities() const noexcept override { return offered(); }

  std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                  RunContext& context) override {
    sdf::ShapeOptions options = sdf::shape_options(parameters_);
    if (parameters_.distance == sdf::DistanceModel::grid)
      options.grid = {.cell = parameters_.cell, .cells_per_edge = static_cast<int>(parameters_.cells_per_edge)};
    return sdf::prepare_shapes(assembly, options, tolerance, context);
  }

  std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                               MotionSpace space) const override {
    return std::make_unique<PenaltyWorld>(sdf::shapes_of(prepared, assembly, scene), scene, space, parameters_);
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
