/// Numbers that a simulator may count on.
#pragma once

#include <algorithm>

#include "dismantle/simulator.h"

namespace dismantle {

/// No infinity, no NaN.
inline bool is_finite(const Pose& pose) { return pose.t.allFinite() && pose.q.coeffs().allFinite(); }
/// The poses and velocities of all bodies.
inline bool is_finite(const State& state) {
  return std::all_of(state.bodies.begin(), state.bodies.end(), [](const BodyState& b) {
    return is_finite(b.pose) && b.velocity.allFinite() && b.angular_velocity.allFinite();
  });
}
/// The forces and torques on all bodies.
inline bool is_finite(const Action& action) {
  return std::all_of(action.wrenches.begin(), action.wrenches.end(),
                     [](const Wrench& w) { return w.force.allFinite() && w.torque.allFinite(); });
}

}  // namespace dismantle
