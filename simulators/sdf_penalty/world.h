/// The scene of one attempt with penalty contact (section 4.1).
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
  struct Inertia {  ///< second order; `acceleration`: of a body of mass 1
    double mass = 1;
    Eigen::Matrix3d about_center;  ///< assembled frame
  };
  enum class Moved { freely, stalled, not_at_all };

  struct Acceleration {
    Eigen::Vector3d linear, angular;  ///< unit/s^2, rad/s^2; world axes
  };

  /// Combines `n` time steps into one.
  template <int Dof>
  Moved step(State& state, const Action& action, double dt, int n, double* travel);
  Eigen::Matrix3d inertia_at(std::size_t body, const BodyState& state) const;
  Acceleration acceleration(std::size_t body, const BodyState& state, const Action& action) const;
  int steps_at_once(const State& state, const Action& action, double dt, int most) const;
  double quasi_static_step(const Action& action) const;
  double distance_from_rest(const Action& action, double duration) const;
  double reach(std::size_t body, const Eigen::Vector3d& turn) const;
  double distance_ahead(const State& before, const State& now, double dt, double rest) const;

  Parameters parameters_;
  std::vector<Inertia> inertia_;  ///< per body
};

}  // namespace dismantle::sdf_penalty
