#include "world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dismantle/geometry/hull.h"

namespace dismantle::sdf_penalty {
namespace {

/// Contacts within this share of a step's travel beyond it are seen in advance, so that nothing is jumped.
constexpr double kMarginFactor = 1.25;
/// Deeper than this after a step means that the linearised contact was too far off: solve again in place.
constexpr double kSettleDepth = 2e-4;
constexpr int kSettleRounds = 3, kRetreatRounds = 6;
/// A step that covers less than this share of a free one counts as standing still.
constexpr double kStallShare = 0.1;
/// Way over which contacts are followed by their own linear model before distances are asked for again. The error is
/// of second order: at a corner a thousandth away 1e-4, over anything smoother far less.
constexpr double kFollow = 5e-4;
/// What only asks for penetration need not see further than this.
constexpr double kSensorMargin = 1e-4;
constexpr int kStallSteps = 3;
/// ... and less than this share is standing still for good: there is no inertia that could change it.
constexpr double kStuckShare = 2e-3;
/// Corrections below this (assembly units) get a body nowhere.
constexpr double kSettleTravel = 1e-7;
/// Hulls count as apart from this gap on: above rounding, below any path step.
constexpr double kSeparationGap = 1e-4;

bool same_poses(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return x.t == y.t && x.q.coeffs() == y.q.coeffs(); });
}

sdf::ContactScene make_scene(const PreparedShapes& prepared, const Cast& cast, const Parameters& p) {
  const auto member = [&](const PlacedPart& part) {
    return sdf::ContactScene::Member{part.part, &prepared.placed[part.part], part.pose};
  };
  std::vector<sdf::ContactScene::Member> moving, still;
  for (const auto& m : cast.moving) moving.push_back(member(m));
  for (const auto& s : cast.still) still.push_back(member(s));
  return {std::move(moving),
          std::move(still),
          p.distance,
          kMarginFactor * p.max_travel,
          [&](PartId a, PartId b) { return prepared.allowed(a, b); },
          p.contact_threshold,
          kFacetAllowance,
          &prepared.rest};
}

}  // namespace

PenaltyWorld::PenaltyWorld(const PreparedShapes& prepared, const Cast& cast, MotionSpace space,
                           const Parameters& parameters)
    : cast_(cast), space_(space), parameters_(parameters), scene_(make_scene(prepared, cast, parameters)) {
  if (cast.moving.empty() || cast.moving.size() > kMaxBodies)
    throw std::invalid_argument("sdf_penalty moves 1 to " + std::to_string(kMaxBodies) + " parts at once");
  per_body_ = space == MotionSpace::translation ? 3 : 6;
  for (std::size_t i = 0; i < cast.moving.size(); ++i) {
    const sdf::Placed& placed = prepared.placed[cast.moving[i].part];
    const sdf::MassProperties& mass = placed.shape->mass;
    Body body;
    body.center = scene_.center(i);
    body.radius = std::max(placed.shape->radius, 1e-9);
    if (parameters.dynamics == Dynamics::density) {
      const Eigen::Matrix3d r = placed.rest.q.toRotationMatrix();
      body.mass = parameters.density * mass.volume;
      body.inertia = parameters.density * (r * mass.inertia * r.transpose());
    } else {
      body.mass = 1;
      body.inertia = body.radius * body.radius * Eigen::Matrix3d::Identity();
    }
    for (const auto& corner : placed.shape->hull) body.hull.push_back(placed.rest * corner);
    bodies_.push_back(std::move(body));
  }
  for (const auto& s : cast.still) {
    const sdf::Placed& placed = prepared.placed[s.part];
    const Pose world = s.pose * placed.rest;
    for (const auto& corner : placed.shape->hull) rest_hull_.push_back(world * corner);
  }
  for (const auto& p : rest_hull_) rest_box_.extend(p);
  poses_.resize(bodies_.size());
}

State PenaltyWorld::initial_state() const {
  State s;
  for (const auto& m : cast_.moving) s.bodies.push_back({m.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  return s;
}

void PenaltyWorld::update_contacts(const State& state) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (same_poses(poses_, touching_at_)) return;
  scene_.update(poses_, touching_);
  rows_current_ = false;
  touching_at_ = poses_;
  since_update_ = 0;
}

/// Contacts after the bodies were displaced by `x`, no point by more than `travel`.
template <int Dof>
void PenaltyWorld::follow_contacts(const State& state, const typename StepSolver<Dof>::Vector& x, double travel) {
  since_update_ += travel;
  if (since_update_ > kFollow) {
    touching_at_.clear();
    return update_contacts(state);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) touching_at_[i] = state.bodies[i].pose;
  if (travel == 0) return;
  rows_current_ = false;
  const auto shift_of = [&](int body, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    if (body < 0) return Eigen::Vector3d::Zero();
    const Eigen::Index at = static_cast<Eigen::Index>(body) * per_body_;
    Eigen::Vector3d d = x.template segment<3>(at);
    if (per_body_ == 6) {
      const Eigen::Vector3d turn = x.template segment<3>(at + 3);
      const auto i = static_cast<std::size_t>(body);
      d += turn.cross(point - state.bodies[i].pose * bodies_[i].center);
    }
    return d;
  };
  for (auto& c : touching_) {
    const Eigen::Vector3d owner = shift_of(c.owner, c.point), relative = owner - shift_of(c.surface, c.point);
    c.gap += c.normal.dot(relative);
    for (int k = 0; k < c.plane_count; ++k) c.planes[k].gap += c.planes[k].normal.dot(relative);
    c.point += owner;
  }
}

void PenaltyWorld::forget_contacts() {
  touching_at_.clear();
  begin_at_.clear();
}

void PenaltyWorld::learn(PartId part, PartId other, const Eigen::Vector3d& point) {
  scene_.add_point(part, other, point);
  sensor_.reset();
  forget_contacts();
}

void PenaltyWorld::relax() {
  forget_contacts();
  scene_.relax();
  sensor_.reset();
}

void PenaltyWorld::build_rows(const State& state, double dt) {
  const bool damped = parameters_.contact_damping > 0 && dt > 0;
  if (rows_current_ && !damped) return;
  rows_.clear();
  rows_current_ = !damped;
  const auto add = [&](const sdf::ContactPoint& c, double gap, const Eigen::Vector3d& normal, int alternatives) {
    ContactRow row;
    row.gap = gap;
    row.stiffness = parameters_.contact_stiffness;
    row.alternatives = alternatives;
    double approach = 0;
    const auto side = [&](int body, double sign, int& first, Eigen::Matrix<double, 6, 1>& j) {
      if (body < 0) return;
      const BodyState& b = state.bodies[static_cast<std::size_t>(body)];
      const Eigen::Vector3d arm = c.point - b.pose * bodies_[static_cast<std::size_t>(body)].center;
      first = body * per_body_;
      j.head<3>() = sign * normal;
      j.tail<3>() = sign * arm.cross(normal);
      approach += j.head<3>().dot(b.velocity) + j.tail<3>().dot(b.angular_velocity);
    };
    side(c.owner, 1.0, row.first, row.j_first);
    side(c.surface, -1.0, row.second, row.j_second);
    // Equation (1): f = (-k_n + k_d d') d n, with the rate of the last step.
    if (damped) row.stiffness = std::max(0.0, row.stiffness - parameters_.contact_damping * approach);
    rows_.push_back(row);
  };
  merger_.clear();
  for (const auto& c : touching_) {
    const std::size_t first = rows_.size();
    add(c, c.gap, c.normal, c.plane_count);
    for (int i = 0; i < c.plane_count; ++i) add(c, c.planes[i].gap, c.planes[i].normal, 0);
    if (per_body_ == 3) merger_.add(rows_, first);
  }
}

template <int Dof>
double PenaltyWorld::displace(State& state, const typename StepSolver<Dof>::Vector& x) const {
  double largest = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Pose& pose = state.bodies[i].pose;
    const auto at = static_cast<Eigen::Index>(i) * per_body_;
    const Eigen::Vector3d d = x.template segment<3>(at);
    double travel = d.norm();
    if (per_body_ == 3) {
      pose.t += d;
    } else {
      const Eigen::Vector3d turn = x.template segment<3>(at + 3);
      const Eigen::Vector3d center = pose * bodies_[i].center + d;
      pose.q = (rotation_from_vector(turn) * pose.q).normalized();
      pose.t = center - pose.q * bodies_[i].center;
      travel += turn.norm() * bodies_[i].radius;
    }
    largest = std::max(largest, travel);
  }
  return largest;
}

/// What holds all bodies back alike, whichever way they go.
template <int Dof>
typename StepSolver<Dof>::Matrix PenaltyWorld::stay_put(double stiffness) const {
  const auto n = static_cast<Eigen::Index>(bodies_.size()) * per_body_;
  typename StepSolver<Dof>::Matrix weight = StepSolver<Dof>::Matrix::Zero(n, n);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (int k = 0; k < per_body_; ++k) {
      const auto at = static_cast<Eigen::Index>(i) * per_body_ + k;
      weight(at, at) = stiffness * (k < 3 ? 1.0 : bodies_[i].radius * bodies_[i].radius);
    }
  return weight;
}

/// Pushes the state out of surfaces that it sank into further than the action's force explains.
template <int Dof>
void PenaltyWorld::settle(State& state, double explained) {
  using Solver = StepSolver<Dof>;
  const auto n = static_cast<Eigen::Index>(bodies_.size()) * per_body_;
  for (int round = 0; round < kSettleRounds; ++round) {
    double deepest = 0;
    for (const auto& c : touching_) deepest = std::max(deepest, -c.gap);
    if (deepest <= kSettleDepth + explained) return;
    build_rows(state, 0);
    const auto weight = stay_put<Dof>(1e-3 * parameters_.contact_stiffness);
    typename Solver::Vector x(n);
    Solver().solve(weight, Solver::Vector::Zero(n), rows_, per_body_, x);
    if (!x.allFinite()) return;
    // A correction larger than a step would be a jump, not a correction.
    double travel = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i) * per_body_;
      travel = std::max(travel, x.template segment<3>(at).norm() +
                                    (per_body_ == 6 ? x.template segment<3>(at + 3).norm() * bodies_[i].radius : 0.0));
    }
    if (travel < kSettleTravel) return;  // squeezed from both sides
    if (travel > parameters_.max_travel) x *= parameters_.max_travel / travel;
    follow_contacts<Dof>(state, x, displace<Dof>(state, x));
  }
}

template <int Dof>
void PenaltyWorld::keep_off(State& state, double clearance) {
  using Solver = StepSolver<Dof>;
  const auto n = static_cast<Eigen::Index>(bodies_.size()) * per_body_;
  for (int round = 0; round < kRetreatRounds; ++round) {
    update_contacts(state);
    build_rows(state, 0);
    for (auto& row : rows_) row.gap -= clearance;
    rows_current_ = false;
    typename Solver::Vector x(n);
    Solver().solve(stay_put<Dof>(1e-2 * parameters_.contact_stiffness), Solver::Vector::Zero(n), rows_, per_body_, x);
    if (!x.allFinite() || displace<Dof>(state, x) < kSettleTravel) return;
  }
}

void PenaltyWorld::retreat(State& state, double clearance) {
  if (bodies_.size() > 1)
    keep_off<Eigen::Dynamic>(state, clearance);
  else if (per_body_ == 3)
    keep_off<3>(state, clearance);
  else
    keep_off<6>(state, clearance);
}

double PenaltyWorld::quasi_static_step(const Action& action) const {
  double speed = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    double v = action.wrenches[i].force.norm();
    if (per_body_ == 6) v += action.wrenches[i].torque.norm() / bodies_[i].radius;
    speed = std::max(speed, v / parameters_.drag);
  }
  return speed > 0 ? parameters_.max_travel / speed : 0;
}

/// Second order: how far the action alone carries a body that is at rest.
double PenaltyWorld::way_from_rest(const Action& action, double duration) const {
  double way = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    double acceleration = action.wrenches[i].force.norm() / bodies_[i].mass;
    if (per_body_ == 6)
      acceleration += action.wrenches[i].torque.norm() * bodies_[i].radius / (bodies_[i].inertia.trace() / 3);
    way = std::max(way, 0.5 * acceleration * duration * duration);
  }
  const double steps = std::max(1.0, duration / parameters_.time_step);
  return std::min(way, steps * parameters_.max_travel);
}

/// One implicit step from the contacts of the last update; leaves them updated.
template <int Dof>
PenaltyWorld::Moved PenaltyWorld::step(State& state, const Action& action, double dt, double* travel) {
  using Solver = StepSolver<Dof>;
  const bool still_water = parameters_.dynamics == Dynamics::quasi_static;
  const auto n = static_cast<Eigen::Index>(bodies_.size()) * per_body_;
  typename Solver::Matrix weight = Solver::Matrix::Zero(n, n);
  typename Solver::Vector target = Solver::Vector::Zero(n);
  double free_travel = 0, largest_force = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * per_body_;
    const Body& body = bodies_[i];
    const BodyState& s = state.bodies[i];
    Wrench wrench = action.wrenches[i];
    if (action.turns_along) wrench = {s.pose.q * wrench.force, s.pose.q * wrench.torque};
    const double r2 = body.radius * body.radius;
    largest_force = std::max(largest_force, wrench.force.norm() + wrench.torque.norm() / body.radius);
    Eigen::Vector3d shift, turn = Eigen::Vector3d::Zero();
    if (still_water) {
      weight.template block<3, 3>(at, at).diagonal().setConstant(parameters_.drag / dt);
      shift = dt / parameters_.drag * wrench.force;
      if (per_body_ == 6) {
        weight.template block<3, 3>(at + 3, at + 3).diagonal().setConstant(parameters_.drag * r2 / dt);
        turn = dt / (parameters_.drag * r2) * wrench.torque;
      }
    } else {
      weight.template block<3, 3>(at, at).diagonal().setConstant(body.mass / (dt * dt));
      shift = dt * s.velocity + dt * dt / body.mass * wrench.force;
      if (per_body_ == 6) {
        const Eigen::Matrix3d r = s.pose.q.toRotationMatrix();
        const Eigen::Matrix3d inertia = r * body.inertia * r.transpose();
        weight.template block<3, 3>(at + 3, at + 3) = inertia / (dt * dt);
        const Eigen::Vector3d torque = wrench.torque - s.angular_velocity.cross(inertia * s.angular_velocity);
        turn = dt * s.angular_velocity + dt * dt * inertia.ldlt().solve(torque);
      }
    }
    const double way = shift.norm() + turn.norm() * body.radius;
    const double scale = way > parameters_.max_travel ? parameters_.max_travel / way : 1.0;
    target.template segment<3>(at) = scale * shift;
    if (per_body_ == 6) target.template segment<3>(at + 3) = scale * turn;
    free_travel = std::max(free_travel, scale * way);
  }
  build_rows(state, dt);
  typename Solver::Vector x(n);
  Solver().solve(weight, target, rows_, per_body_, x);
  if (!x.allFinite()) {
    *travel = std::numeric_limits<double>::quiet_NaN();
    return Moved::stalled;
  }
  *travel = displace<Dof>(state, x);
  if (!still_water)
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i) * per_body_;
      state.bodies[i].velocity = x.template segment<3>(at) / dt;
      if (per_body_ == 6) state.bodies[i].angular_velocity = x.template segment<3>(at + 3) / dt;
    }
  follow_contacts<Dof>(state, x, *travel);
  if (*travel < kStuckShare * free_travel) return Moved::not_at_all;
  if (still_water) settle<Dof>(state, largest_force / parameters_.contact_stiffness);
  return *travel < kStallShare * free_travel ? Moved::stalled : Moved::freely;
}

StepReport PenaltyWorld::advance(State& state, const Action& action, double duration, Trace* trace) {
  if (action.wrenches.size() != bodies_.size() || state.bodies.size() != bodies_.size())
    throw std::invalid_argument("state and action need one entry per moving part");
  StepReport report;
  const State begin = state;
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (same_poses(poses_, begin_at_)) {
    touching_ = begin_touching_;
    touching_at_ = begin_at_;
    since_update_ = 0;
    rows_ = begin_rows_;
    rows_current_ = true;
  } else {
    if (since_update_ > 0) touching_at_.clear();
    update_contacts(state);
    begin_touching_ = touching_;
    begin_at_ = touching_at_;
    build_rows(state, 0);
    begin_rows_ = rows_;
    rows_current_ = true;
  }
  const bool quasi_static = parameters_.dynamics == Dynamics::quasi_static;
  const double natural = quasi_static ? quasi_static_step(action) : parameters_.time_step;
  if (!(natural > 0)) {  // no force, no inertia: nothing happens
    report.stalled = true;
    return report;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / natural - 1e-9)));
  const double dt = duration / steps;
  int idle = 0;
  for (int k = 0; k < steps; ++k) {
    double travel = 0;
    Moved moved;
    if (bodies_.size() > 1)
      moved = step<Eigen::Dynamic>(state, action, dt, &travel);
    else if (per_body_ == 3)
      moved = step<3>(state, action, dt, &travel);
    else
      moved = step<6>(state, action, dt, &travel);
    ++report.steps;
    if (!std::isfinite(travel)) {
      state = begin;
      report.finite = false;
      report.stalled = true;
      return report;
    }
    if (trace != nullptr) {
      std::vector<Pose> instant;
      for (const auto& b : state.bodies) instant.push_back(b.pose);
      trace->push_back(std::move(instant));
    }
    idle = moved == Moved::freely ? 0 : idle + 1;
    if (quasi_static && (idle >= kStallSteps || moved == Moved::not_at_all)) {
      report.stalled = true;
      break;
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    report.travel = std::max(report.travel, screw_travel(begin.bodies[i].pose, state.bodies[i].pose, bodies_[i].center,
                                                         per_body_ == 3 ? 0.0 : bodies_[i].radius));
  // To and fro in place is standing still, too.
  const double free = quasi_static ? parameters_.max_travel * duration / natural : way_from_rest(action, duration);
  if (report.travel < kStallShare * free) report.stalled = true;
  return report;
}

double PenaltyWorld::penetration(const State& state) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (!same_poses(poses_, touching_at_)) {
    if (!sensor_) sensor_ = std::make_unique<sdf::ContactScene>(scene_.with_margin(kSensorMargin));
    sensor_->update(poses_, sensed_);
  }
  double deepest = 0;
  for (const auto& c : same_poses(poses_, touching_at_) ? touching_ : sensed_) deepest = std::max(deepest, -c.gap);
  return deepest;
}

void PenaltyWorld::contacts(const State& state, std::vector<Contact>& out) {
  update_contacts(state);
  out.clear();
  for (const auto& c : touching_) {
    Contact contact;
    Eigen::Vector3d normal = c.normal;
    double gap = c.gap;
    for (int k = 0; k < c.plane_count; ++k)  // as the solver sees it
      if (c.planes[k].gap > gap) gap = c.planes[k].gap, normal = c.planes[k].normal;
    contact.on_edge = c.plane_count > 0;
    contact.point = c.point;
    contact.depth = -gap;
    const bool owner_moves = c.owner >= 0;
    contact.moving = owner_moves ? c.owner_part : c.surface_part;
    contact.other = owner_moves ? c.surface_part : c.owner_part;
    contact.normal = owner_moves ? normal : Eigen::Vector3d(-normal);
    out.push_back(contact);
  }
}

bool PenaltyWorld::separated(const State& state) {
  if (rest_hull_.empty()) return true;
  std::vector<Eigen::Vector3d> moving;
  Aabb box;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (const auto& corner : bodies_[i].hull) {
      moving.push_back(state.bodies[i].pose * corner);
      box.extend(moving.back());
    }
  return separate(moving, rest_hull_, kSeparationGap).has_value();
}

}  // namespace dismantle::sdf_penalty
