#include "dismantle/push_search/proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dismantle/geometry/slippage.h"
#include "dismantle/push_search/actions.h"
#include "dismantle/push_search/touching_surfaces.h"

namespace dismantle::push {
namespace {

using geometry::Twist;

/// Approximate length along the screw after which the hulls are disjoint, without obstacles; infinite if they never
/// are.
double length_until_out(const Problem& problem, const State& from, const Twist& screw, const Eigen::Vector3d& center) {
  // An advance of less than the tolerance per turn does not separate the part, but the rotation may, for a part of the
  // turn: one turn is examined.
  const bool turns = !screw.angular.isZero(0);
  const double turn = turns ? 2 * std::numbers::pi / screw.angular.norm() : 0;
  const double advance = turns ? std::abs(screw.linear.dot(screw.angular.normalized())) : screw.linear.norm();
  const bool advances = !turns || advance * turn > problem.query.tolerance;
  const double most = advances ? problem.extents.longest_exit() / advance : turn;
  const double growth = problem.tactics.glide_growth;
  State there = from;
  const auto next = [&](double length) {
    const double step = std::max(problem.glide_step(), growth * length);
    return length + (length < turn ? std::min(step, growth * turn) : step);
  };
  for (double length = problem.glide_step(); length < most; length = next(length)) {
    for (std::size_t i = 0; i < there.bodies.size(); ++i)
      there.bodies[i].pose = geometry::moved_along(from.bodies[i].pose, screw, center, length);
    if (problem.world->separated(there)) return length;
  }
  return std::numeric_limits<double>::infinity();
}

/// Pushes the bodies along each axis and adds the contacts found there, moved back to `state`: a part with clearance on
/// all sides touches nothing, although the surfaces around guide it.
void add_contacts_of_pushes(Problem& problem, Work& work, const State& state, std::vector<Contact>& contacts) {
  for (const Action& action : unit_actions(*problem.world, problem.tactics.force, false, problem.axes)) {
    if (work.used_up()) return;
    State pushed = state;
    const StepReport report = problem.world->advance(pushed, action, problem.tactics.time_step);
    work.count_steps(report.steps);
    if (!report.finite) continue;
    for (Contact& c : problem.contacts(pushed)) {
      for (std::size_t i = 0; i < state.bodies.size(); ++i) {
        if (problem.query.scene.moving[i].part != c.moving) continue;
        const Pose back = state.bodies[i].pose * pushed.bodies[i].pose.inverse();
        c.point = back * c.point;
        c.normal = back.q * c.normal;
      }
      contacts.push_back(c);
    }
  }
}

/// Rotations that the contacts allow, with pressure along their axes in both directions, to find a slot there.
std::vector<Action> leaning_rotations(Problem& problem, Work& work, const State& state) {
  std::vector<Action> actions;
  for (const Twist& screw : proposed_screws(problem, work, state)) {
    if (screw.angular.norm() * problem.world->torque_arm(0) < screw.linear.norm()) continue;
    const Eigen::Vector3d axis = screw.angular.normalized();
    for (const double sign : {1.0, -1.0})
      actions.push_back(along(problem, screw, state, sign * problem.tactics.lean * axis));
  }
  return actions;
}

}  // namespace

std::vector<Twist> proposed_screws(Problem& problem, Work& work, const State& state) {
  const Eigen::Vector3d center = problem.center(state);
  const double arm = problem.world->torque_arm(0);
  const auto& moving = problem.query.scene.moving;
  std::vector<Contact> contacts = problem.contacts(state);
  std::vector<Twist> slips = geometry::slippable_motions(touching_surfaces(contacts, moving), center, arm);
  if (slips.empty()) {
    add_contacts_of_pushes(problem, work, state, contacts);
    slips = geometry::slippable_motions(touching_surfaces(contacts, moving), center, arm);
  }
  std::vector<std::pair<double, Twist>> by_length;
  for (const Twist& t : slips)
    for (const double sign : {1.0, -1.0}) {
      const Twist screw{sign * t.linear, sign * t.angular};
      by_length.emplace_back(length_until_out(problem, state, screw, center), screw);
    }
  std::stable_sort(by_length.begin(), by_length.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Twist> screws;
  for (const auto& [length, screw] : by_length) screws.push_back(screw);
  return screws;
}

Action along(const Problem& problem, const Twist& screw, const State& state, const Eigen::Vector3d& lean) {
  Action action;
  action.in_body_frame = true;
  const double force = problem.tactics.force;
  const Eigen::Vector3d center = problem.center(state);
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const Pose& pose = state.bodies[i].pose;
    const double arm = problem.world->torque_arm(i);
    const Eigen::Vector3d v = screw.linear + screw.angular.cross(pose * problem.bodies[i].center - center) + lean;
    action.wrenches.push_back(
        {pose.q.conjugate() * (force * v), pose.q.conjugate() * (force * arm * arm * screw.angular)});
  }
  return action;
}

bool screw_leads_out(const Problem& problem) {
  const State start = problem.world->initial_state();
  const Eigen::Vector3d center = problem.center(start);
  const std::vector<Twist> guided = geometry::guided_motions(
      touching_surfaces(problem.contacts(start), problem.query.scene.moving), center, problem.world->torque_arm(0));
  if (std::any_of(guided.begin(), guided.end(), [](const Twist& t) { return t.angular.isZero(0); })) return false;
  return std::any_of(guided.begin(), guided.end(), [&](const Twist& t) {
    return std::isfinite(length_until_out(problem, start, t, center)) ||
           std::isfinite(length_until_out(problem, start, {-t.linear, -t.angular}, center));
  });
}

std::vector<Action> actions_at(Problem& problem, Work& work, const State& state, Stage stage) {
  const World& world = *problem.world;
  const double force = problem.tactics.force;
  switch (stage) {
    case Stage::axes:
      return unit_actions(world, force, problem.rotates(), problem.axes);
    case Stage::diagonals:
      return diagonal_actions(world, force, problem.axes);
    case Stage::screws:
      return screw_actions(world, force, problem.axes);
    case Stage::one_driven:
      return one_driven(world, force, problem.rotates(), problem.axes);
    case Stage::two_along:
    case Stage::two_across:
      return two_driven(world, force, problem.rotates(), problem.axes, stage == Stage::two_across);
    case Stage::twists:
    case Stage::free:
    case Stage::leaning:
      break;
  }
  if (problem.rotates()) return leaning_rotations(problem, work, state);
  const Freedom freedom =
      freedom_of(problem.contacts(state), problem.query.scene.moving, problem.extents, problem.tactics);
  std::vector<Action> actions;
  for (const auto& d : stage == Stage::free ? freedom.directions : leaning(freedom, problem.tactics.lean))
    actions.push_back(push(world, force, d));
  return actions;
}

}  // namespace dismantle::push
