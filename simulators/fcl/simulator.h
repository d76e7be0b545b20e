/// Geometric simulator: collision and penetration depth.
#pragma once

#include <memory>

#include "dismantle/simulator.h"
#include "parameters.h"

namespace dismantle::mesh_collision {

inline Capabilities provided() { return {.dynamics = false, .contacts = false, .distance = true, .max_moving = 64}; }

class FclSimulator final : public Simulator {
 public:
  explicit FclSimulator(const Parameters& parameters) : parameters_(parameters) {}

  Capabilities capabilities() const noexcept override { return provided(); }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                  RunContext& context) override;
  std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                               MotionSpace space) const override;

 private:
  Parameters parameters_;
};

}  // namespace dismantle::mesh_collision
