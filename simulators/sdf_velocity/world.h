/// The scene of one attempt with contact at velocity level.
#pragma once

#include <vector>

#include "contact_projection.h"
#include "dismantle/sdf/body_world.h"
#include "parameters.h"

namespace dismantle::sdf_velocity {

/// No inertia: a free body moves at force / drag. In contact it makes the motion nearest to that without penetration.
class VelocityWorld final : public sdf::BodyWorld {
 public:
  VelocityWorld(const sdf::PreparedShapes& prepared, const Scene& scene, MotionSpace space,
                const Parameters& parameters);

  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override;

 private:
  using Vector = ContactProjection::Vector;
  struct Step {
    double free = 0;    ///< motion under the action alone
    double travel = 0;  ///< bound of the motion of any point
  };

  Vector free_motion(const State& state, const Action& action) const;
  Step step(State& state, const Action& action, double free_travel, double limit);
  double certain_share(const State& state, const Vector& x) const;

  Parameters parameters_;
  std::vector<double> radii_;
  double blind_travel_;  // largest motion of a point beyond its known free distance
  ContactProjection projection_;
};

}  // namespace dismantle::sdf_velocity
