/// Checks that the numbers of a state or action are finite.
#pragma once

#include <algorithm>

#include "dismantle/simulator.h"

namespace dismantle {

/// True without infinity and NaN.
inline bool is_finite(const Pose& pose) { return pose.t.allFinite() && pose.q.coeffs().allFinite(); }
/// Checks the poses and velocities of all bodies.
inline bool is_finite(const State& state) {
  return std::all_of(state.bodies.begin(), state.bodies.end(), [](const BodyState& b) {
    return is_finite(b.pose) && b.velocity.allFinite() && b.angular_velocity.allFinite();
  });
}
/// Checks the forces and torques on all bodies.
inline bool is_finite(const Action& action) {
  return std::all_of(action.wrenches.begin(), action.wrenches.end(),
                     [](const Wrench& w) { return w.force.allFinite() && w.torque.allFinite(); });
}

}  // namespace dismantle
