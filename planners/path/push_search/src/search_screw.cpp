// Runs along screw motions: gliding where nothing is in the way, simulating where something is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "dismantle/geometry/slippage.h"
#include "dismantle/path/placed_parts.h"
#include "dismantle/push/search.h"
#include "dismantle/push/touching_surfaces.h"

namespace dismantle::push {
namespace {

/// Way between two looks at penetration while gliding: as it begins, the longest that it grows to while nothing is in
/// the way, and the shortest tried before giving up (assembly units). What is thinner than a step may be jumped; the
/// judge sees it, and from then on steps do not grow.
constexpr double kGlideStep = 0.1, kMostGlideStep = 2.4, kLeastGlideStep = 0.0125;
/// Steps grow to this share of the way that was clear.
constexpr double kGlideShare = 0.125;
/// Penetration that counts as none, as a share of the tolerance.
constexpr double kGlideDepthShare = 0.1;
/// The room that a part is given before it glides on; assembly units.
constexpr double kGlideClearance = 0.02;
/// A glide that covers less is not worth another one.
constexpr double kLeastGlide = 0.15;
/// What is kept of a glide that got stuck.
constexpr double kKept = 0.75;
/// Way between two looks at everything else.
constexpr double kGlideLook = 0.3;
/// Ways along a screw at which we look whether the hulls are apart grow by this factor, up to the most.
constexpr double kWayOutFactor = 1.25, kMostWayOut = 2000;
/// A push that feels goes on by this share of the planning step until something is as near as that (assembly units),
/// or so many times.
constexpr double kFeelShare = 0.08, kFelt = 2e-3;
constexpr int kFeelLooks = 40;
/// Share of turning from which on a screw is one, and the axial share of a push that leans.
constexpr double kTurns = 0.3, kAslant = 0.5;
/// Half turns with a smaller sine do not tell their axis.
constexpr double kTellsAxis = 0.3;

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

/// How far along the screw the hulls are apart, were nothing in the way; roughly, infinite if they never are.
double Search::way_out(const State& from, const Twist& twist, const Eigen::Vector3d& center) {
  const double most = twist.angular.isZero(0) ? kMostWayOut / 10 : kMostWayOut;
  State there = from;
  for (double way = kGlideStep; way < most; way *= kWayOutFactor) {
    for (std::size_t i = 0; i < there.bodies.size(); ++i)
      there.bodies[i].pose = geometry::moved_along(from.bodies[i].pose, twist, center, way);
    if (world_->separated(there)) return way;
  }
  return std::numeric_limits<double>::infinity();
}

/// What the bodies touch first when they are pushed, every way in turn, as if they did where they are: a part that
/// stands free in its play touches nothing, though surfaces close by guide it.
void Search::feel(const State& state, std::vector<Contact>& contacts) {
  std::vector<Contact> there;
  for (const Action& action : unit_actions(*world_, tactics_.force, false, axes_)) {
    State moved_on = state;
    StepReport report;
    double nearest = -1;
    for (int look = 0; look < kFeelLooks && nearest < -kFelt && report.finite && !report.stalled; ++look) {
      if (out_of_budget()) return;
      report = world_->advance(moved_on, action, kFeelShare * tactics_.time_step);
      steps_ += report.steps;
      if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min(*limits_.steps_left, report.steps);
      world_->contacts(moved_on, there);
      for (const Contact& c : there) nearest = std::max(nearest, c.depth);
    }
    if (!report.finite) continue;
    for (Contact& c : there) {
      for (std::size_t i = 0; i < state.bodies.size(); ++i) {
        if (query_.scene.moving[i].part != c.moving) continue;
        const Pose back = state.bodies[i].pose * moved_on.bodies[i].pose.inverse();
        c.point = back * c.point;
        c.normal = back.q * c.normal;
      }
      contacts.push_back(c);
    }
  }
}

/// Along what the contacts let slip, both ways, the shorter way out first.
std::vector<Twist> Search::twists_at(const Node& node) {
  const Eigen::Vector3d center = node.state.bodies[0].pose * bodies_[0].center;
  const double arm = world_->torque_arm(0);
  std::vector<Contact> contacts;
  world_->contacts(node.state, contacts);
  std::vector<Twist> slips = geometry::slippable_motions(touching_surfaces(contacts, query_.scene.moving), center, arm);
  if (slips.empty()) {
    feel(node.state, contacts);
    slips = geometry::slippable_motions(touching_surfaces(contacts, query_.scene.moving), center, arm);
  }
  std::vector<std::pair<double, Twist>> by_way;
  for (const Twist& t : slips)
    for (const double sign : {1.0, -1.0}) {
      const Twist twist{sign * t.linear, sign * t.angular};
      by_way.emplace_back(way_out(node.state, twist, center), twist);
    }
  std::stable_sort(by_way.begin(), by_way.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Twist> twists;
  for (const auto& [way, twist] : by_way) twists.push_back(twist);
  return twists;
}

/// Moves along a screw exactly as long as nothing is entered: far faster than by simulation, and the path is clean.
Search::GlideEnd Search::glide(const Twist& twist, unsigned depth, Run& run) {
  const Eigen::Vector3d center = run.state.bodies[0].pose * bodies_[0].center;
  const State start = run.state;
  const double most = short_glides_ ? kGlideStep : kMostGlideStep;
  State look = run.state;
  double step = kGlideStep, way = 0, looked = 0, noted = run.length;
  int in_a_row = 0;
  bool left_start = false;
  const auto at = [&](double along) {
    State there = start;
    for (auto& b : there.bodies) b.pose = geometry::moved_along(b.pose, twist, center, along);
    return there;
  };
  while (true) {
    if (out_of_budget()) return GlideEnd::stop;
    const State next = at(way + step);
    ++looks_;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min<std::uint64_t>(*limits_.steps_left, 1);
    if (world_->penetration(next) > kGlideDepthShare * query_.tolerance) {
      step *= 0.5;
      in_a_row = 0;
      if (step < kLeastGlideStep) return GlideEnd::blocked;
      continue;
    }
    // Instants and states are as dense as if every step had been short.
    const int instants = std::max(1, static_cast<int>(std::ceil(step / kGlideStep - 1e-9)));
    for (int k = 1; k <= instants; ++k) {
      run.state = at(way + k * step / instants);
      run.length += step / instants;
      run.way.push_back(path::poses_of(run.state));
      if (run.length < noted + kGlideLook * (1 - 1e-9) || seen_.similar(run.state, look)) continue;
      noted = run.length;
      look = run.state;
      run.last = add_node(run.last, depth, run.state, std::move(run.way), true);
      run.way.clear();
      run.marks.emplace_back(run.length, run.last);
      if (tactics_.intermediate > 0) enqueue(run.last);
    }
    way += step;
    if (++in_a_row >= 2 && 2 * step <= std::max(kGlideStep, kGlideShare * way))
      step = std::min(most, 2 * step), in_a_row = 0;
    if (way < looked + kGlideLook * (1 - 1e-9)) continue;
    looked = way;
    if (world_->separated(run.state)) return GlideEnd::out;
    left_start = left_start || !seen_.similar(run.state, start);
    if (left_start && seen_.has_similar(run.state, run.first, static_cast<std::uint32_t>(nodes_.size())))
      return GlideEnd::known;
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
  world_->project_to_clearance(run.state, kGlideClearance);
  run.way.push_back(path::poses_of(run.state));
  const State start = run.state;
  double turned = 0;
  Pose stuck_at = start.bodies[0].pose;
  while (true) {
    const double before = run.length;
    const GlideEnd end = glide(twist, depth, run);
    if (end == GlideEnd::stop) return RunEnd::stop;
    if (end == GlideEnd::out) {
      const RunEnd verified = verify(add_node(run.last, depth, run.state, std::move(run.way), false), origin, result);
      if (verified == RunEnd::refused || verified == RunEnd::refused_learned) short_glides_ = true;
      return verified;
    }
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
    world_->project_to_clearance(run.state, kGlideClearance);
    run.way.push_back(path::poses_of(run.state));
    twist =
        refit(twist, start.bodies[0].pose, run.state.bodies[0].pose, bodies_[0].center, world_->torque_arm(0), turned);
  }
  if (!run.way.empty() && run.length > 0) {
    if (fine_.has_similar(run.state) && run.last != from) return RunEnd::blocked;
    run.last = add_node(run.last, depth, run.state, std::move(run.way), false);
  }
  return follow(run.last, along(twist, run.state), Stage::twists, depth, result);
}

/// The wrench that drives the bodies along a screw from where they are, turning with them.
Action Search::along(const Twist& twist, const State& state, const Eigen::Vector3d& lean) const {
  Action action;
  action.in_body_frame = true;
  const Eigen::Vector3d center = state.bodies[0].pose * bodies_[0].center;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Pose& pose = state.bodies[i].pose;
    const double arm = world_->torque_arm(i);
    const Eigen::Vector3d v = twist.linear + twist.angular.cross(pose * bodies_[i].center - center) + lean;
    action.wrenches.push_back(
        {pose.q.conjugate() * (tactics_.force * v), pose.q.conjugate() * (tactics_.force * arm * arm * twist.angular)});
  }
  return action;
}

/// Along the turns that the contacts leave free, while leaning along their axes: the way to find a slot there.
std::vector<Action> Search::leaning_turns(const Node& node) {
  std::vector<Action> actions;
  for (const Twist& twist : twists_at(node)) {
    if (twist.angular.norm() * world_->torque_arm(0) < kTurns) continue;
    const Eigen::Vector3d axis = twist.angular.normalized();
    for (const double sign : {1.0, -1.0}) actions.push_back(along(twist, node.state, sign * kAslant * axis));
  }
  return actions;
}

}  // namespace dismantle::push
