/// The scene of one attempt under contact at velocity level.
#pragma once

#include <vector>

#include "contact_projection.h"
#include "dismantle/sdf/body_world.h"
#include "parameters.h"

namespace dismantle::sdf_velocity {

/// No inertia: a free body moves at force / drag. In contact it makes, of all motions that enter nothing, the one
/// nearest to that.
class VelocityWorld final : public sdf::BodyWorld {
 public:
  VelocityWorld(const sdf::PreparedShapes& prepared, const Scene& scene, MotionSpace space,
                const Parameters& parameters);

  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override;

 private:
  using Vector = ContactProjection::Vector;
  struct Step {
    double free = 0;  ///< way that the action alone would have led
    double way = 0;   ///< bound of the way of any point
  };

  Vector free_motion(const State& state, const Action& action) const;
  Step step(State& state, const Action& action, double free_way, double limit);
  double certain_share(const State& state, const Vector& x) const;

  Parameters parameters_;
  std::vector<double> radii_;
  double blind_travel_;  // of a point where it is not certain what it may meet
  ContactProjection projection_;
};

}  // namespace dismantle::sdf_velocity
