#include "dismantle/plugin.h"
#include "world.h"

namespace dismantle::sdf_velocity {
namespace {

Capabilities offered() { return {.dynamics = true, .contacts = true, .distance = true, .max_moving = sdf::kMaxBodies}; }

class VelocitySimulator final : public Simulator {
 public:
  explicit VelocitySimulator(const Parameters& parameters) : parameters_(parameters) {}

  Capabilities capabilities() const noexcept override { return offered(); }

  std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                  RunContext& context) override {
    return sdf::prepare_shapes(assembly, sdf::shape_options(parameters_), tolerance, context);
  }

  std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                               MotionSpace space) const override {
    return std::make_unique<VelocityWorld>(sdf::shapes_of(prepared, assembly, scene), scene, space, parameters_);
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::sdf_velocity

DISMANTLE_PLUGIN("dismantle.sdf_velocity", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::Simulator, dismantle::sdf_velocity::VelocitySimulator, dismantle::sdf_velocity::Parameters>(
      "sdf_velocity", "Rigid bodies under hard contact at velocity level on signed distance fields.",
      {.source = "Goldfarb and Idnani 1983 (quadratic program)", .provides = dismantle::sdf_velocity::offered()});
}
