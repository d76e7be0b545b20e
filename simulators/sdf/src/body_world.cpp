#include "dismantle/sdf/body_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/plugin/finite.h"

namespace dismantle::sdf {
namespace {

bool same_poses(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return x.t == y.t && x.q.coeffs() == y.q.coeffs(); });
}

ContactScene make_scene(const PreparedShapes& prepared, const Scene& scene, const ContactOptions& options) {
  const auto member = [&](const PlacedPart& part) {
    return ContactScene::Member{part.part, &prepared.placed[part.part], part.pose};
  };
  std::vector<ContactScene::Member> moving, fixed;
  for (const auto& m : scene.moving) moving.push_back(member(m));
  for (const auto& s : scene.fixed) fixed.push_back(member(s));
  return {std::move(moving),
          std::move(fixed),
          options.distance,
          options.margin,
          [&](PartId a, PartId b) { return prepared.allowed(a, b); },
          {.threshold = options.threshold,
           .everywhere = prepared.tolerance,
           .slack = prepared.facet_allowance,
           .contact = prepared.contact_depth},
          &prepared.rest};
}

}  // namespace

BodyWorld::BodyWorld(const PreparedShapes& prepared, const Scene& scene, MotionSpace space,
                     const ContactOptions& options)
    : scene_(scene),
      space_(space),
      options_(options),
      contact_depth_(prepared.contact_depth),
      contact_scene_(make_scene(prepared, scene, options)) {
  if (scene.moving.empty() || scene.moving.size() > kMaxBodies)
    throw std::invalid_argument("1 to " + std::to_string(kMaxBodies) + " parts can move simultaneously, not " +
                                std::to_string(scene.moving.size()));
  if (options.surroundings) contact_scene_.see_surroundings();
  per_body_ = space == MotionSpace::translation ? 3 : 6;
  for (std::size_t i = 0; i < scene.moving.size(); ++i) {
    const Placed& placed = prepared.placed[scene.moving[i].part];
    MovingBody body;
    body.center = contact_scene_.center(i);
    body.radius = std::max(placed.shape->radius, geometry::kRounding);
    for (const auto& corner : placed.shape->hull) body.hull.push_back(placed.rest * corner);
    bodies_.push_back(std::move(body));
  }
  for (const auto& s : scene.fixed) {
    const Placed& placed = prepared.placed[s.part];
    const Pose world = s.pose * placed.rest;
    for (const auto& corner : placed.shape->hull) rest_hull_.push_back(world * corner);
  }
  poses_.resize(bodies_.size());
}

State BodyWorld::initial_state() const {
  State s;
  for (const auto& m : scene_.moving) s.bodies.push_back({m.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  return s;
}

void BodyWorld::update_contacts(const State& state) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (same_poses(poses_, touching_at_)) return;
  contact_scene_.update(poses_, touching_);
  rows_current_ = false;
  touching_at_ = poses_;
  since_update_ = 0;
}

double BodyWorld::deepest() const {
  double depth = 0;
  for (const auto& c : touching_) depth = std::max(depth, -c.gap);
  return depth;
}

bool BodyWorld::begin(const State& state, const Action& action) {
  if (action.wrenches.size() != bodies_.size() || state.bodies.size() != bodies_.size())
    throw std::invalid_argument("state and action need one entry per moving part");
  if (!is_finite(state) || !is_finite(action)) return false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (same_poses(poses_, begin_at_)) {
    touching_ = begin_touching_;
    touching_at_ = begin_at_;
    since_update_ = 0;
    rows_ = begin_rows_;
  } else {
    if (since_update_ > 0) touching_at_.clear();
    update_contacts(state);
    begin_touching_ = touching_;
    begin_at_ = touching_at_;
    build_rows(state, 0);
    begin_rows_ = rows_;
  }
  rows_current_ = true;
  return true;
}

template <int Dof>
Eigen::Vector3d BodyWorld::shift_of(int body, const Eigen::Vector3d& point, const State& state,
                                    const typename StepSolver<Dof>::Vector& x) const {
  if (body < 0) return Eigen::Vector3d::Zero();
  const Eigen::Index at = static_cast<Eigen::Index>(body) * per_body_;
  Eigen::Vector3d d = x.template segment<3>(at);
  if (per_body_ == 6) {
    const Eigen::Vector3d turn = x.template segment<3>(at + 3);
    const auto i = static_cast<std::size_t>(body);
    d += turn.cross(point - state.bodies[i].pose * bodies_[i].center);
  }
  return d;
}

template <int Dof>
void BodyWorld::follow_contacts(const State& state, const typename StepSolver<Dof>::Vector& x, double travel) {
  // The error of the linear contact model is of second order in the motion.
  since_update_ += travel;
  if (since_update_ > contact_depth_) {
    touching_at_.clear();
    return update_contacts(state);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) touching_at_[i] = state.bodies[i].pose;
  if (travel == 0) return;
  rows_current_ = false;
  for (auto& c : touching_) {
    const Eigen::Vector3d owner = shift_of<Dof>(c.owner, c.point, state, x),
                          relative = owner - shift_of<Dof>(c.surface, c.point, state, x);
    c.gap += c.normal.dot(relative);
    for (int k = 0; k < c.plane_count; ++k) c.planes[k].gap += c.planes[k].normal.dot(relative);
    c.point += owner;
  }
}

void BodyWorld::forget_contacts() {
  touching_at_.clear();
  begin_at_.clear();
}

void BodyWorld::add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point) {
  contact_scene_.add_point(part, other, point);
  sensor_.reset();
  forget_contacts();
}

void BodyWorld::allow_overlap_everywhere() {
  forget_contacts();
  contact_scene_.allow_overlap_everywhere();
  sensor_.reset();
}

void BodyWorld::build_rows(const State& state, double dt) {
  const bool damped = options_.damping > 0 && dt > 0;
  if (rows_current_ && !damped) return;
  rows_.clear();
  rows_current_ = !damped;
  const auto add = [&](const ContactPoint& c, double gap, const Eigen::Vector3d& normal, int alternatives) {
    ContactRow row;
    row.gap = gap;
    row.stiffness = options_.stiffness;
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
    if (damped) row.stiffness = std::max(0.0, row.stiffness - options_.damping * approach);
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
double BodyWorld::displace(State& state, const typename StepSolver<Dof>::Vector& x) const {
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

template <int Dof>
double BodyWorld::travel_of(const typename StepSolver<Dof>::Vector& x) const {
  double largest = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * per_body_;
    double travel = x.template segment<3>(at).norm();
    if (per_body_ == 6) travel += x.template segment<3>(at + 3).norm() * bodies_[i].radius;
    largest = std::max(largest, travel);
  }
  return largest;
}

template <int Dof>
typename StepSolver<Dof>::Matrix BodyWorld::stay_put(double stiffness) const {
  const auto n = dof();
  typename StepSolver<Dof>::Matrix weight = StepSolver<Dof>::Matrix::Zero(n, n);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (int k = 0; k < per_body_; ++k) {
      const auto at = static_cast<Eigen::Index>(i) * per_body_ + k;
      weight(at, at) = stiffness * (k < 3 ? 1.0 : bodies_[i].radius * bodies_[i].radius);
    }
  return weight;
}

template <int Dof>
void BodyWorld::settle(State& state, double depth) {
  using Solver = StepSolver<Dof>;
  const auto n = dof();
  for (int round = 0; round < 3; ++round) {  // Newton rounds; the next step corrects the rest
    if (deepest() <= depth) return;
    build_rows(state, 0);
    const auto weight = stay_put<Dof>(1e-3 * options_.stiffness);
    typename Solver::Vector x(n);
    Solver(columns_).solve(weight, Solver::Vector::Zero(n), rows_, per_body_, x);
    if (!x.allFinite()) return;
    // A correction larger than a step would be a jump, not a correction.
    const double travel = travel_of<Dof>(x);
    if (travel < geometry::kRounding * bodies_.front().radius) return;  // blocked from both sides
    if (travel > options_.max_travel) x *= options_.max_travel / travel;
    follow_contacts<Dof>(state, x, displace<Dof>(state, x));
  }
}

template <int Dof>
void BodyWorld::keep_off(State& state, double clearance) {
  using Solver = StepSolver<Dof>;
  const auto n = dof();
  for (int round = 0; round < 6; ++round) {  // early rounds bring other contacts near
    update_contacts(state);
    build_rows(state, 0);
    for (auto& row : rows_) row.gap -= clearance;
    rows_current_ = false;
    typename Solver::Vector x(n);
    Solver(columns_).solve(stay_put<Dof>(1e-2 * options_.stiffness), Solver::Vector::Zero(n), rows_, per_body_, x);
    if (!x.allFinite() || displace<Dof>(state, x) < geometry::kRounding * bodies_.front().radius) return;
  }
}

double BodyWorld::room(const State& state, double most) {
  update_contacts(state);
  double least = most;
  for (const auto& c : touching_) {
    double gap = c.gap;
    for (int k = 0; k < c.plane_count; ++k) gap = std::max(gap, c.planes[k].gap);
    least = std::min(least, gap);
  }
  return least;
}

/// In a tight place, many contacts would push the body into the few on the other side. So the wanted clearance is
/// halved until all contacts can have it. A body deep inside another one stays there.
void BodyWorld::project_to_clearance(State& state, double clearance) {
  clearance = std::min(clearance, options_.margin);
  double most = room(state, clearance);
  for (double wanted = clearance; most < wanted && wanted > contact_depth_; wanted /= 2) {
    State there = state;
    if (bodies_.size() > 1)
      keep_off<Eigen::Dynamic>(there, wanted);
    else if (per_body_ == 3)
      keep_off<3>(there, wanted);
    else
      keep_off<6>(there, wanted);
    const double has = room(there, wanted);
    if (has > most) state = there, most = has;
    if (2 * most > wanted || most < -clearance) return;
  }
}

double BodyWorld::penetration(const State& state) {
  if (!is_finite(state)) return std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = state.bodies[i].pose;
  if (!same_poses(poses_, touching_at_)) {
    if (!sensor_) sensor_ = std::make_unique<ContactScene>(contact_scene_.with_margin(0));
    sensor_->update(poses_, sensed_);
  }
  double depth = 0;
  for (const auto& c : same_poses(poses_, touching_at_) ? touching_ : sensed_) depth = std::max(depth, -c.gap);
  return depth;
}

void BodyWorld::contacts(const State& state, std::vector<Contact>& out) {
  update_contacts(state);
  out.clear();
  for (const auto& c : touching_) {
    Contact contact;
    Eigen::Vector3d normal = c.normal;
    double gap = c.gap;
    for (int k = 0; k < c.plane_count; ++k)  // as in the solver
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

bool BodyWorld::separated(const State& state) {
  if (!is_finite(state)) return false;
  if (rest_hull_.empty()) return true;
  std::vector<Eigen::Vector3d> moving;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (const auto& corner : bodies_[i].hull) moving.push_back(state.bodies[i].pose * corner);
  return separate(moving, rest_hull_, contact_depth_).has_value();
}

bool BodyWorld::body_separated(const State& state, std::size_t body) {
  if (!is_finite(state)) return false;
  std::vector<Eigen::Vector3d> alone, others = rest_hull_;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (const auto& corner : bodies_[i].hull) (i == body ? alone : others).push_back(state.bodies[i].pose * corner);
  return others.empty() || separate(alone, others, contact_depth_).has_value();
}

#define DISMANTLE_BODY_WORLD(DOF)                                                                      \
  template void BodyWorld::follow_contacts<DOF>(const State&, const StepSolver<DOF>::Vector&, double); \
  template double BodyWorld::displace<DOF>(State&, const StepSolver<DOF>::Vector&) const;              \
  template double BodyWorld::travel_of<DOF>(const StepSolver<DOF>::Vector&) const;                     \
  template Eigen::Vector3d BodyWorld::shift_of<DOF>(int, const Eigen::Vector3d&, const State&,         \
                                                    const StepSolver<DOF>::Vector&) const;             \
  template void BodyWorld::settle<DOF>(State&, double);                                                \
  template StepSolver<DOF>::Matrix BodyWorld::stay_put<DOF>(double) const
DISMANTLE_BODY_WORLD(3);
DISMANTLE_BODY_WORLD(6);
DISMANTLE_BODY_WORLD(Eigen::Dynamic);
#undef DISMANTLE_BODY_WORLD

}  // namespace dismantle::sdf
