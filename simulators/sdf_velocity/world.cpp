#include "world.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"
#include "dismantle/plugin/finite.h"

namespace dismantle::sdf_velocity {
namespace {

sdf::ContactOptions contact_options(const Parameters& p) {
  return {.surroundings = true, .margin = p.max_travel, .threshold = p.contact_threshold, .max_travel = p.max_travel};
}

}  // namespace

VelocityWorld::VelocityWorld(const sdf::PreparedShapes& prepared, const Scene& scene, MotionSpace space,
                             const Parameters& parameters)
    : BodyWorld(prepared, scene, space, contact_options(parameters)),
      parameters_(parameters),
      blind_travel_(parameters.blind_travel * prepared.tolerance),
      projection_(contact_depth(), prepared.tolerance) {
  for (const auto& body : bodies()) radii_.push_back(body.radius);
}

/// Displacement of all bodies in one second under the action alone.
VelocityWorld::Vector VelocityWorld::free_motion(const State& state, const Action& action) const {
  Vector motion = Vector::Zero(dof());
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * per_body();
    Wrench wrench = action.wrenches[i];
    if (action.in_body_frame) {
      const auto& q = state.bodies[i].pose.q;
      wrench = {q * wrench.force, q * wrench.torque};
    }
    motion.segment<3>(at) = wrench.force / parameters_.drag;
    if (per_body() == 6) motion.segment<3>(at + 3) = wrench.torque / (parameters_.drag * radii_[i] * radii_[i]);
  }
  return motion;
}

/// Largest share of x that moves each point by at most its known free distance plus blind_travel_.
double VelocityWorld::certain_share(const State& state, const Vector& x) const {
  double share = 1;
  for (const auto& c : touching()) {
    const double travel =
        (shift_of<Eigen::Dynamic>(c.owner, c.point, state, x) - shift_of<Eigen::Dynamic>(c.surface, c.point, state, x))
            .norm();
    const double certain = c.certain + blind_travel_;
    if (travel * share > certain) share = certain / travel;
  }
  return share;
}

/// One step from the contacts of the last update, which it updates. No point moves by more than `limit`, and the free
/// motion is at most `free_way`.
VelocityWorld::Step VelocityWorld::step(State& state, const Action& action, double free_travel, double limit) {
  const Vector motion = free_motion(state, action);
  const double speed = travel_of<Eigen::Dynamic>(motion);
  Vector x(dof());
  const auto try_travel = [&](double travel) {
    projection_.project(rows(), per_body(), radii_, travel / speed * motion, x);
    return travel_of<Eigen::Dynamic>(x);
  };
  build_rows(state, 0);
  // Contact may reduce the motion so much that all of it fits into one step.
  Step done;
  done.free = free_travel;
  done.travel = try_travel(done.free);
  if (done.travel < geometry::kRounding * done.free) return {done.free, 0};
  if (done.travel > limit && done.free > limit) {
    done.free = std::max(limit, done.free * limit / done.travel);
    done.travel = try_travel(done.free);
  }
  // A shorter step along x penetrates no more than x does.
  const double share = std::min(done.travel > limit ? limit / done.travel : 1.0, certain_share(state, x));
  x *= share;
  done.free *= share;
  done.travel = displace<Eigen::Dynamic>(state, x);
  update_contacts(state);
  return done;
}

StepReport VelocityWorld::advance(State& state, const Action& action, double duration, Trace* trace) {
  StepReport report;
  const auto not_finite = [&report] {
    report.finite = false;
    report.stalled = true;
    return report;
  };
  if (!begin(state, action)) return not_finite();
  const State begin_state = state;
  const std::size_t begin_trace = trace != nullptr ? trace->size() : 0;
  const double free = duration * travel_of<Eigen::Dynamic>(free_motion(state, action));
  if (!std::isfinite(free)) return not_finite();  // force too large
  if (!(free > 0)) {                              // no force: no motion
    report.stalled = true;
    return report;
  }
  double left = free, limit = parameters_.max_travel;
  while (left > 1e-9 * free) {
    const State before = state;
    const double allowed = std::max(contact_depth(), deepest());
    const Step done = step(state, action, left, limit);
    ++report.steps;
    if (!std::isfinite(done.travel) || !is_finite(state)) {
      state = begin_state;
      if (trace != nullptr) trace->resize(begin_trace);
      return not_finite();
    }
    report.stalled = done.travel == 0;
    if (report.stalled) break;
    settle<Eigen::Dynamic>(state, contact_depth());
    // A step that penetrates and cannot be corrected in place is undone and halved.
    if (deepest() > allowed) {
      state = before;
      update_contacts(state);
      limit = 0.5 * std::min(limit, done.travel);
      report.stalled = limit < contact_depth();
      if (report.stalled) break;
      continue;
    }
    left -= done.free;
    limit = std::min(2 * limit, parameters_.max_travel);
    if (trace != nullptr) {
      std::vector<Pose> instant;
      for (const auto& b : state.bodies) instant.push_back(b.pose);
      trace->push_back(std::move(instant));
    }
  }
  for (std::size_t i = 0; i < bodies().size(); ++i)
    report.travel =
        std::max(report.travel, screw_travel(begin_state.bodies[i].pose, state.bodies[i].pose, bodies()[i].center,
                                             per_body() == 3 ? 0.0 : bodies()[i].radius));
  // A part that only oscillates has stalled, too.
  if (report.travel < parameters_.stall_share * free) report.stalled = true;
  return report;
}

}  // namespace dismantle::sdf_velocity
