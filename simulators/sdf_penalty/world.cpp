#include "world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/plugin/finite.h"

namespace dismantle::sdf_penalty {
namespace {

sdf::ContactOptions contact_options(const Parameters& p) {
  return {.distance = p.distance,
          .margin = 1.25 * p.max_travel,  // detects contacts slightly beyond one step, so none is skipped
          .threshold = p.contact_threshold,
          .stiffness = p.contact_stiffness,
          .damping = p.contact_damping,
          .max_travel = p.max_travel};
}

}  // namespace

PenaltyWorld::PenaltyWorld(const sdf::PreparedShapes& prepared, const Scene& scene, MotionSpace space,
                           const Parameters& parameters)
    : BodyWorld(prepared, scene, space, contact_options(parameters)), parameters_(parameters) {
  for (std::size_t i = 0; i < scene.moving.size(); ++i) {
    const sdf::Placed& placed = prepared.placed[scene.moving[i].part];
    const MassProperties& mass = placed.shape->mass;
    Inertia inertia;
    const Eigen::Matrix3d r = placed.rest.q.toRotationMatrix();
    if (parameters.dynamics == Dynamics::density) {
      inertia.mass = parameters.density * mass.volume;
      inertia.about_center = parameters.density * (r * mass.inertia * r.transpose());
    } else if (parameters.dynamics == Dynamics::acceleration) {
      inertia.about_center = r * mass.inertia * r.transpose() / mass.volume;
    } else {
      inertia.about_center = bodies()[i].radius * bodies()[i].radius * Eigen::Matrix3d::Identity();
    }
    inertia_.push_back(inertia);
  }
}

double PenaltyWorld::quasi_static_step(const Action& action) const {
  double speed = 0;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    double v = action.wrenches[i].force.norm();
    if (per_body() == 6) v += action.wrenches[i].torque.norm() / bodies()[i].radius;
    speed = std::max(speed, v / parameters_.drag);
  }
  return speed > 0 ? parameters_.max_travel / speed : 0;
}

/// Second order: motion of a body from rest under the action alone.
double PenaltyWorld::distance_from_rest(const Action& action, double duration) const {
  double path_length = 0;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    double acceleration = action.wrenches[i].force.norm() / inertia_[i].mass;
    const double inertia = parameters_.dynamics == Dynamics::acceleration ? 1 : inertia_[i].about_center.trace() / 3;
    if (per_body() == 6) acceleration += action.wrenches[i].torque.norm() * bodies()[i].radius / inertia;
    path_length = std::max(path_length, 0.5 * acceleration * duration * duration);
  }
  const double steps = std::max(1.0, duration / parameters_.time_step);
  return std::min(path_length, steps * parameters_.max_travel);
}

/// Largest motion of any point of a body in a small turn (rotation vector, body axes) about its centre. A long screw
/// that turns about its axis hardly moves.
double PenaltyWorld::reach(std::size_t body, const Eigen::Vector3d& turn) const {
  if (turn.isZero()) return 0;
  double most = 0;
  for (const auto& p : bodies()[body].hull) most = std::max(most, turn.cross(p - bodies()[body].center).squaredNorm());
  return std::sqrt(most);
}

/// Second order: motion in the next `rest` seconds at the speed and acceleration of the last step, which began at
/// `before`.
double PenaltyWorld::distance_ahead(const State& before, const State& now, double dt, double rest) const {
  double path_length = 0;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    const BodyState &was = before.bodies[i], &is = now.bodies[i];
    const double arm = per_body() == 6 ? bodies()[i].radius : 0;
    const double speed = is.velocity.norm() + arm * is.angular_velocity.norm();
    const double gain = (is.velocity - was.velocity).norm() + arm * (is.angular_velocity - was.angular_velocity).norm();
    path_length = std::max(path_length, rest * (speed + 0.5 * gain / dt * rest));
  }
  return path_length;
}

Eigen::Matrix3d PenaltyWorld::inertia_at(std::size_t body, const BodyState& state) const {
  const Eigen::Matrix3d r = state.pose.q.toRotationMatrix();
  return r * inertia_[body].about_center * r.transpose();
}

/// Second order: acceleration of the body without contact.
PenaltyWorld::Acceleration PenaltyWorld::acceleration(std::size_t body, const BodyState& state,
                                                      const Action& action) const {
  Wrench wrench = action.wrenches[body];
  if (action.in_body_frame) wrench = {state.pose.q * wrench.force, state.pose.q * wrench.torque};
  Acceleration a{wrench.force / inertia_[body].mass, Eigen::Vector3d::Zero()};
  if (per_body() == 3) return a;
  const Eigen::Matrix3d inertia = inertia_at(body, state);
  const Eigen::Vector3d gyroscopic = state.angular_velocity.cross(inertia * state.angular_velocity);
  a.angular = parameters_.dynamics == Dynamics::acceleration
                  ? Eigen::Vector3d(wrench.torque - inertia.ldlt().solve(gyroscopic))
                  : Eigen::Vector3d(inertia.ldlt().solve(wrench.torque - gyroscopic));
  return a;
}

/// Number of time steps that move no point further than `max_travel`, at least one.
int PenaltyWorld::steps_at_once(const State& state, const Action& action, double dt, int most) const {
  double time = most * dt;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    const BodyState& s = state.bodies[i];
    const Acceleration a = acceleration(i, s, action);
    const Eigen::Quaterniond to_body = s.pose.q.conjugate();
    const double speed = s.velocity.norm() + reach(i, to_body * s.angular_velocity);
    const double gain = a.linear.norm() + reach(i, to_body * a.angular);
    if (gain > 0)
      time = std::min(
          time, 2 * parameters_.max_travel / (speed + std::sqrt(speed * speed + 4 * gain * parameters_.max_travel)));
    else if (speed > 0)
      time = std::min(time, parameters_.max_travel / speed);
  }
  return std::clamp(static_cast<int>(time / dt + 1e-9), 1, most);
}

/// One implicit step from the contacts of the last update, which it updates.
template <int Dof>
PenaltyWorld::Moved PenaltyWorld::step(State& state, const Action& action, double dt, int n_steps, double* travel) {
  using Solver = sdf::StepSolver<Dof>;
  const bool fixed_water = parameters_.dynamics == Dynamics::quasi_static;
  const auto n = dof();
  typename Solver::Matrix weight = Solver::Matrix::Zero(n, n);
  typename Solver::Vector target = Solver::Vector::Zero(n);
  double free_travel = 0, largest_force = 0;
  // Without contacts, the sum of the single steps has a closed form.
  const bool flies = !fixed_water && n_steps > 1 && touching().empty();
  const double gain = flies ? dt * dt * (n_steps + 1) / (2.0 * n_steps) : dt * dt;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * per_body();
    const sdf::MovingBody& body = bodies()[i];
    const BodyState& s = state.bodies[i];
    Wrench wrench = action.wrenches[i];
    if (action.in_body_frame) wrench = {s.pose.q * wrench.force, s.pose.q * wrench.torque};
    const double r2 = body.radius * body.radius;
    largest_force = std::max(largest_force, wrench.force.norm() + wrench.torque.norm() / body.radius);
    Eigen::Vector3d shift, turn = Eigen::Vector3d::Zero();
    if (fixed_water) {
      weight.template block<3, 3>(at, at).diagonal().setConstant(parameters_.drag / dt);
      shift = dt / parameters_.drag * wrench.force;
      if (per_body() == 6) {
        weight.template block<3, 3>(at + 3, at + 3).diagonal().setConstant(parameters_.drag * r2 / dt);
        turn = dt / (parameters_.drag * r2) * wrench.torque;
      }
    } else {
      weight.template block<3, 3>(at, at).diagonal().setConstant(inertia_[i].mass / (dt * dt));
      const Acceleration a = acceleration(i, s, action);
      shift = dt * s.velocity + gain * a.linear;
      if (per_body() == 6) {
        weight.template block<3, 3>(at + 3, at + 3) = inertia_at(i, s) / (dt * dt);
        turn = dt * s.angular_velocity + gain * a.angular;
      }
    }
    const double arm_travel = fixed_water ? turn.norm() * body.radius : reach(i, s.pose.q.conjugate() * turn);
    const double path_length = shift.norm() + arm_travel;
    const double scale = path_length > parameters_.max_travel ? parameters_.max_travel / path_length : 1.0;
    target.template segment<3>(at) = scale * shift;
    if (per_body() == 6) target.template segment<3>(at + 3) = scale * turn;
    free_travel = std::max(free_travel, scale * path_length);
  }
  build_rows(state, dt);
  typename Solver::Vector x(n);
  Solver(columns()).solve(weight, target, rows(), per_body(), x);
  if (!x.allFinite()) {
    *travel = std::numeric_limits<double>::quiet_NaN();
    return Moved::stalled;
  }
  if (!fixed_water)
    for (std::size_t i = 0; i < bodies().size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i) * per_body();
      BodyState& s = state.bodies[i];
      const Acceleration a = acceleration(i, s, action);
      const double late = flies ? (n_steps - 1) * dt / (2.0 * n_steps) : 0;  // the final speed exceeds the mean
      s.velocity = x.template segment<3>(at) / dt + late * a.linear;
      if (per_body() == 6) s.angular_velocity = x.template segment<3>(at + 3) / dt + late * a.angular;
    }
  *travel = displace<Dof>(state, x);
  follow_contacts<Dof>(state, x, *travel);
  // Without inertia the next step would be equal.
  if (fixed_water && *travel < contact_depth()) return Moved::not_at_all;
  if (fixed_water) settle<Dof>(state, contact_depth() + largest_force / parameters_.contact_stiffness);
  return *travel < parameters_.stall_share * free_travel ? Moved::stalled : Moved::freely;
}

StepReport PenaltyWorld::advance(State& state, const Action& action, double duration, Trace* trace) {
  StepReport report;
  const auto not_finite = [&report] {
    report.finite = false;
    report.stalled = true;
    return report;
  };
  if (!begin(state, action)) return not_finite();
  const State begin_state = state;
  const std::size_t begin_trace = trace != nullptr ? trace->size() : 0;
  const bool quasi_static = parameters_.dynamics == Dynamics::quasi_static;
  const double natural = quasi_static ? quasi_static_step(action) : parameters_.time_step;
  if (!(natural > 0)) {  // no force, no inertia: no motion
    report.stalled = true;
    return report;
  }
  const double wanted = std::ceil(duration / natural - 1e-9);
  if (!(wanted <= std::numeric_limits<int>::max())) return not_finite();  // force too large
  const int steps = std::max(1, static_cast<int>(wanted));
  const double dt = duration / steps;
  const double free = quasi_static ? parameters_.max_travel * duration / natural : distance_from_rest(action, duration);
  const bool may_rest = !quasi_static && parameters_.rest_share > 0;
  State before;
  int idle = 0;
  for (int k = 0; k < steps;) {
    const int n = !quasi_static && parameters_.adaptive ? steps_at_once(state, action, dt, steps - k) : 1;
    k += n;
    double travel = 0;
    Moved moved;
    if (may_rest) before = state;
    if (bodies().size() > 1)
      moved = step<Eigen::Dynamic>(state, action, n * dt, n, &travel);
    else if (per_body() == 3)
      moved = step<3>(state, action, n * dt, n, &travel);
    else
      moved = step<6>(state, action, n * dt, n, &travel);
    ++report.steps;
    if (!std::isfinite(travel) || !is_finite(state)) {
      state = begin_state;
      if (trace != nullptr) trace->resize(begin_trace);
      return not_finite();
    }
    if (trace != nullptr) {
      std::vector<Pose> instant;
      for (const auto& b : state.bodies) instant.push_back(b.pose);
      trace->push_back(std::move(instant));
    }
    idle = moved == Moved::freely ? 0 : idle + 1;  // contacts may change once or twice before the body moves again
    if (quasi_static && (idle >= 3 || moved == Moved::not_at_all)) {
      report.stalled = true;
      break;
    }
    if (may_rest && k < steps &&
        distance_ahead(before, state, n * dt, duration - k * dt) <= parameters_.rest_share * free)
      break;
  }
  for (std::size_t i = 0; i < bodies().size(); ++i)
    report.travel =
        std::max(report.travel, screw_travel(begin_state.bodies[i].pose, state.bodies[i].pose, bodies()[i].center,
                                             per_body() == 3 ? 0.0 : bodies()[i].radius));
  // A part that only oscillates has stalled, too.
  if (report.travel < parameters_.stall_share * free) report.stalled = true;
  return report;
}

}  // namespace dismantle::sdf_penalty
