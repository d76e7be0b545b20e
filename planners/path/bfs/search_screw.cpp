// Runs along screw motions: gliding where nothing is in the way, simulating where something is.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "search.h"

namespace dismantle::bfs {
namespace {

/// Way between two looks at penetration while gliding, and the shortest tried before giving up (assembly units). What
/// is thinner than a step may be jumped; the judge sees it.
constexpr double kGlideStep = 0.1, kLeastGlideStep = 0.0125;
/// Penetration that counts as none, and the room that a part is given before it glides on.
constexpr double kGlideDepth = 1e-3, kGlideClearance = 0.02;
/// A glide that covers less is not worth another one.
constexpr double kLeastGlide = 0.15;
/// What is kept of a glide that got stuck.
constexpr double kKept = 0.75;
/// Steps between two looks at everything else.
constexpr int kGlideLook = 3;
/// Half turns with a smaller sine do not tell their axis.
constexpr double kTellsAxis = 0.3;

Path::value_type poses_of(const State& state) {
  Path::value_type poses;
  for (const auto& b : state.bodies) poses.push_back(b.pose);
  return poses;
}

/// The screw that has led from `from` to `to` after `turned` rad about nearly `rough`: both poses have been put in the
/// middle of their room, so that this is closer to the truth than what the contacts told.
Twist refit(const Twist& rough, const Pose& from, const Pose& to, const Eigen::Vector3d& local_center, double radius,
            double turned) {
  const Eigen::Vector3d was = from * local_center, is = to * local_center;
  Twist fit;
  if (turned < 1e-3) {
    fit.linear = (is - was).normalized();
    return fit;
  }
  Eigen::Vector3d axis = rough.angular.normalized();
  Eigen::Vector3d on_axis = is + axis.cross(rough.linear) / rough.angular.norm();
  Eigen::Quaterniond q = to.q * from.q.conjugate();
  double half = std::atan2(q.vec().norm(), q.w());  // in [0, pi]
  Eigen::Vector3d about = q.vec().norm() > 1e-9 ? Eigen::Vector3d(q.vec().normalized()) : axis;
  if (about.dot(axis) < 0) about = -about, half = -half;
  constexpr double kTurn = 2 * 3.14159265358979323846;
  const double angle = 2 * half + kTurn * std::round((turned - 2 * half) / kTurn);
  if (std::abs(std::sin(half)) > kTellsAxis && about.dot(axis) > 0.9) {
    axis = about;
    const Eigen::Vector3d way = is - was, across = way - axis * axis.dot(way);
    on_axis = 0.5 * (was + is) + 0.5 / std::tan(half) * axis.cross(across);
  }
  const double pitch = axis.dot(is - was) / angle;
  fit.angular = axis;
  fit.linear = axis.cross(is - on_axis) + pitch * axis;
  const double size = fit.linear.norm() + radius;
  fit.linear /= size;
  fit.angular /= size;
  return fit;
}

}  // namespace

/// Along what the contacts let slip, both ways, the shorter way out first.
std::vector<Twist> Search::twists_at(const Node& node) {
  std::vector<Contact> contacts;
  world_->contacts(node.state, contacts);
  const Eigen::Vector3d center = node.state.bodies[0].pose * bodies_[0].center;
  std::vector<Twist> twists;
  for (const Twist& t : slipping(contacts, query_.cast.moving, center, world_->torque_arm(0)))
    for (const double sign : {1.0, -1.0}) twists.push_back({sign * t.linear, sign * t.angular});
  return twists;
}

/// Moves along a screw exactly as long as nothing is entered: far faster than by simulation, and the path is clean.
Search::GlideEnd Search::glide(const Twist& twist, unsigned depth, Run& run) {
  State look = run.state;
  const Eigen::Vector3d center = run.state.bodies[0].pose * bodies_[0].center;
  const State start = run.state;
  double step = kGlideStep, way = 0;
  bool left_start = false;
  for (int k = 1;; ++k) {
    if (out_of_budget()) return GlideEnd::stop;
    State next = start;
    for (auto& b : next.bodies) b.pose = moved(b.pose, twist, center, way + step);
    ++looks_;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min<std::uint64_t>(*limits_.steps_left, 1);
    if (world_->penetration(next) > kGlideDepth) {
      step *= 0.5;
      if (step < kLeastGlideStep) return GlideEnd::blocked;
      continue;
    }
    way += step;
    run.length += step;
    run.state = next;
    run.way.push_back(poses_of(next));
    if (k % kGlideLook != 0) continue;
    if (world_->separated(next)) return GlideEnd::out;
    left_start = left_start || !seen_.similar(next, start);
    const auto size = static_cast<std::uint32_t>(nodes_.size());
    if (left_start && seen_.has_similar(next, run.first, size)) return GlideEnd::known;
    if (seen_.similar(next, look)) continue;
    look = next;
    run.last = add_node(run.last, depth, next, std::move(run.way), true);
    run.way.clear();
    run.marks.emplace_back(run.length, run.last);
    if (parameters_.intermediate > 0) enqueue(run.last);
  }
}

/// Glides along a screw; where it gets stuck the part is put in the middle of its room and the screw is fitted anew.
/// The rest is simulated with a wrench that turns along.
Search::RunEnd Search::follow_screw(std::int32_t from, Twist twist, unsigned depth, PathResult& result) {
  const State origin = nodes_[static_cast<std::size_t>(from)].state;
  Run run;
  run.state = origin;
  run.last = from;
  run.first = static_cast<std::uint32_t>(nodes_.size());
  world_->retreat(run.state, kGlideClearance);
  run.way.push_back(poses_of(run.state));
  const State start = run.state;
  double turned = 0;
  Pose stuck_at = start.bodies[0].pose;
  while (true) {
    const double before = run.length;
    const GlideEnd end = glide(twist, depth, run);
    if (end == GlideEnd::stop) return RunEnd::stop;
    if (end == GlideEnd::out)
      return judge(add_node(run.last, depth, run.state, std::move(run.way), false), origin, result);
    if (end == GlideEnd::known) return RunEnd::blocked;
    const Pose& here = run.state.bodies[0].pose;
    if (screw_travel(stuck_at, here, bodies_[0].center, world_->radius(0)) < kLeastGlide) break;
    stuck_at = here;
    // A screw that is a little off closes in on the surface: go back to where there was room.
    while (!run.marks.empty() && run.marks.back().first > before + kKept * (run.length - before)) run.marks.pop_back();
    if (!run.marks.empty() && run.marks.back().first > before) {
      std::tie(run.length, run.last) = run.marks.back();
      run.state = nodes_[static_cast<std::size_t>(run.last)].state;
      run.way.clear();
    }
    turned += (run.length - before) * twist.angular.norm();
    world_->retreat(run.state, kGlideClearance);
    run.way.push_back(poses_of(run.state));
    twist =
        refit(twist, start.bodies[0].pose, run.state.bodies[0].pose, bodies_[0].center, world_->torque_arm(0), turned);
  }
  if (!run.way.empty() && run.length > 0) {
    if (fine_.has_similar(run.state) && run.last != from) return RunEnd::blocked;
    run.last = add_node(run.last, depth, run.state, std::move(run.way), false);
  }
  Action action;
  action.turns_along = true;
  const Eigen::Vector3d center = run.state.bodies[0].pose * bodies_[0].center;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Pose& pose = run.state.bodies[i].pose;
    const double arm = world_->torque_arm(i);
    const Eigen::Vector3d v = twist.linear + twist.angular.cross(pose * bodies_[i].center - center);
    action.wrenches.push_back({pose.q.conjugate() * (parameters_.force * v),
                               pose.q.conjugate() * (parameters_.force * arm * arm * twist.angular)});
  }
  return follow(run.last, action, Stage::twists, depth, result);
}

}  // namespace dismantle::bfs
