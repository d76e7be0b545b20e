/// The scene of one attempt under penalty contact (section 4.1).
#pragma once

#include <vector>

#include "dismantle/sdf/body_world.h"
#include "parameters.h"

namespace dismantle::sdf_penalty {

class PenaltyWorld final : public sdf::BodyWorld {
 public:
  PenaltyWorld(const sdf::PreparedShapes& prepared, const Scene& scene, MotionSpace space,
               const Parameters& parameters);

  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override;

 private:
  struct Inertia {  ///< second order
    double mass = 1;
    Eigen::Matrix3d about_center;  ///< assembled frame
  };
  enum class Moved { freely, stalled, not_at_all };

  template <int Dof>
  Moved step(State& state, const Action& action, double dt, double* travel);
  double quasi_static_step(const Action& action) const;
  double way_from_rest(const Action& action, double duration) const;

  Parameters parameters_;
  std::vector<Inertia> inertia_;  ///< per body
};

}  // namespace dismantle::sdf_penalty
