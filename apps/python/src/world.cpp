#include "world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/errors.h"

namespace dismantle::python {
namespace {

[[noreturn]] void closed() { throw Error("this world belongs to a query that is over"); }

}  // namespace

MotionSpace motion_space(const std::string& text) {
  if (text == "rigid") return MotionSpace::rigid;
  if (text == "translation") return MotionSpace::translation;
  throw py::value_error("space: expected 'rigid' or 'translation', got '" + text + "'");
}

double* write_state(const BodyState& body, double* to) {
  const Pose& pose = body.pose;
  to = std::copy_n(pose.t.data(), 3, to);
  *to++ = pose.q.w();
  to = std::copy_n(pose.q.vec().data(), 3, to);
  to = std::copy_n(body.velocity.data(), 3, to);
  return std::copy_n(body.angular_velocity.data(), 3, to);
}

State state_of(const Array& rows, std::size_t bodies) {
  const bool flat = bodies == 1 && rows.ndim() == 1 && rows.size() == static_cast<py::ssize_t>(kStateColumns);
  if (!flat && (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(0)) != bodies ||
                static_cast<std::size_t>(rows.shape(1)) != kStateColumns))
    throw py::value_error(fmt::format("state: expected an array of shape ({}, 13)", bodies));
  State state;
  for (std::size_t i = 0; i < bodies; ++i) {
    const double* row = rows.data() + kStateColumns * i;
    Array pose(7);
    std::copy_n(row, 7, pose.mutable_data());
    BodyState& body = state.bodies.emplace_back();
    body.pose = pose_of(pose, "state");
    body.velocity = {row[7], row[8], row[9]};
    body.angular_velocity = {row[10], row[11], row[12]};
    if (!body.velocity.allFinite() || !body.angular_velocity.allFinite())
      throw py::value_error("state: a velocity is not finite");
  }
  return state;
}

HeldWorld::HeldWorld(std::shared_ptr<const Assembly> assembly, Make make, std::shared_ptr<Work> work)
    : assembly_(std::move(assembly)),
      make_(std::move(make)),
      world_(make_()),
      work_(work != nullptr ? std::move(work) : std::make_shared<Work>()),
      bodies_(world_->scene().moving.size()),
      state_(world_->initial_state()) {}

void HeldWorld::close() {
  py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  world_.reset();
  make_ = nullptr;
}

World& HeldWorld::world() {
  if (world_ == nullptr) closed();
  return *world_;
}

World& HeldWorld::world_with_body(std::size_t body) {
  if (body >= bodies_) throw py::index_error(fmt::format("no moving part {}: there are {}", body, bodies_));
  return world();
}

template <class Do>
auto HeldWorld::at(State& state, Do work) {
  py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  return work(world(), state);
}

void HeldWorld::begin_anew(State state) {
  world();
  {
    py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    if (!make_) closed();
    world_ = make_();
    for (const Sample& s : samples_) world_->add_contact_sample(s.part, s.other, s.point);
    if (overlap_everywhere_) world_->allow_overlap_everywhere();
  }
  state_ = std::move(state);
}

Array HeldWorld::state_rows() const {
  Array out({bodies_, kStateColumns});
  double* to = out.mutable_data();
  for (const BodyState& body : state_.bodies) to = write_state(body, to);
  return out;
}

void HeldWorld::set_state(const Array& rows) { begin_anew(state_of(rows, bodies_)); }

State HeldWorld::state_at(const py::object& poses) const {
  if (poses.is_none()) return state_;
  const std::vector<Pose> rows = poses_of(py::cast<Array>(poses), "poses");
  if (rows.size() != bodies_)
    throw py::value_error(fmt::format("poses: expected {} rows, one per moving part", bodies_));
  State state;
  for (const Pose& pose : rows) state.bodies.push_back({pose});
  return state;
}

void HeldWorld::set_poses(const Array& rows) { begin_anew(state_at(rows)); }

void HeldWorld::reset() { begin_anew(world().initial_state()); }

StepOutcome HeldWorld::step(const Array& wrench, double duration, bool in_body_frame) {
  const bool flat = bodies_ == 1 && wrench.ndim() == 1 && wrench.size() == 6;
  if (!flat && (wrench.ndim() != 2 || static_cast<std::size_t>(wrench.shape(0)) != bodies_ || wrench.shape(1) != 6))
    throw py::value_error(
        fmt::format("wrench: expected an array of shape {}", bodies_ == 1 ? "(6,)" : fmt::format("({}, 6)", bodies_)));
  if (!(duration > 0) || !std::isfinite(duration))
    throw py::value_error("duration: expected a finite number > 0, seconds");
  Action action;
  action.in_body_frame = in_body_frame;
  for (std::size_t i = 0; i < bodies_; ++i) {
    const double* row = wrench.data() + 6 * i;
    action.wrenches.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
    if (!action.wrenches.back().force.allFinite() || !action.wrenches.back().torque.allFinite())
      throw py::value_error("wrench: a number is not finite");
  }
  StepOutcome outcome;
  outcome.bodies = bodies_;
  State next = state_;
  outcome.report =
      at(next, [&](World& world, State& state) { return world.advance(state, action, duration, &outcome.trace); });
  work_->steps += outcome.report.steps;
  state_ = std::move(next);
  return outcome;
}

double HeldWorld::penetration(const py::object& poses) {
  State state = state_at(poses);
  ++work_->state_checks;
  return at(state, [](World& world, const State& s) { return world.penetration(s); });
}

ContactList HeldWorld::contacts(const py::object& poses) {
  State state = state_at(poses);
  ++work_->state_checks;
  ContactList list;
  at(state, [&](World& world, const State& s) { world.contacts(s, list.contacts); });
  return list;
}

bool HeldWorld::separated(const py::object& poses) {
  State state = state_at(poses);
  return at(state, [](World& world, const State& s) { return world.separated(s); });
}

bool HeldWorld::body_separated(std::size_t body) {
  world_with_body(body);
  State state = state_;
  return at(state, [body](World& world, const State& s) { return world.body_separated(s, body); });
}

void HeldWorld::project_to_clearance(double clearance) {
  if (!(clearance >= 0) || !std::isfinite(clearance))
    throw py::value_error("clearance: expected a finite number >= 0, assembly units");
  State next = state_;
  ++work_->state_checks;
  at(next, [clearance](World& world, State& s) { world.project_to_clearance(s, clearance); });
  state_ = std::move(next);
}

void HeldWorld::add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point) {
  if (!point.allFinite()) throw py::value_error("point: a number is not finite");
  at(state_, [&](World& world, const State&) { world.add_contact_sample(part, other, point); });
  samples_.push_back({part, other, point});
}

void HeldWorld::allow_overlap_everywhere() {
  at(state_, [](World& world, const State&) { world.allow_overlap_everywhere(); });
  overlap_everywhere_ = true;
}

}  // namespace dismantle::python
