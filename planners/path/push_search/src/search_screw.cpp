// Screw motions that contacts propose.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dismantle/geometry/slippage.h"
#include "dismantle/path/placed_parts.h"
#include "dismantle/push/search.h"
#include "dismantle/push/touching_surfaces.h"

namespace dismantle::push {

/// Approximate length along the screw after which the hulls are disjoint, without obstacles; infinite if they never
/// are.
double Search::way_out(const State& from, const Twist& twist, const Eigen::Vector3d& center) {
  // An advance of less than the tolerance per turn does not separate the part, but the rotation may, for a part of the
  // turn: one turn is examined.
  const bool turns = !twist.angular.isZero(0);
  const double turn = turns ? 2 * std::numbers::pi / twist.angular.norm() : 0;
  const double advance = turns ? std::abs(twist.linear.dot(twist.angular.normalized())) : twist.linear.norm();
  const bool advances = !turns || advance * turn > query_.tolerance;
  const double most = advances ? extents_.longest_way_out() / advance : turn;
  State there = from;
  const auto next = [&](double way) {
    const double step = std::max(glide_step(), tactics_.glide_growth * way);
    return way + (way < turn ? std::min(step, tactics_.glide_growth * turn) : step);
  };
  for (double way = glide_step(); way < most; way = next(way)) {
    for (std::size_t i = 0; i < there.bodies.size(); ++i)
      there.bodies[i].pose = geometry::moved_along(from.bodies[i].pose, twist, center, way);
    if (world_->separated(there)) return way;
  }
  return std::numeric_limits<double>::infinity();
}

/// Pushes the bodies along each axis and adds the contacts found there, moved back to `state`: a part with clearance on
/// all sides touches nothing, although the surfaces around guide it.
void Search::add_contacts_of_pushes(const State& state, std::vector<Contact>& contacts) {
  std::vector<Contact> there;
  for (const Action& action : unit_actions(*world_, tactics_.force, false, axes_)) {
    if (out_of_budget()) return;
    State pushed = state;
    const StepReport report = world_->advance(pushed, action, tactics_.time_step);
    steps_ += report.steps;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min(*limits_.steps_left, report.steps);
    if (!report.finite) continue;
    world_->contacts(pushed, there);
    for (Contact& c : there) {
      for (std::size_t i = 0; i < state.bodies.size(); ++i) {
        if (query_.scene.moving[i].part != c.moving) continue;
        const Pose back = state.bodies[i].pose * pushed.bodies[i].pose.inverse();
        c.point = back * c.point;
        c.normal = back.q * c.normal;
      }
      contacts.push_back(c);
    }
  }
}

/// Slippable motions along the contacts, in both directions, the shortest way out first.
std::vector<Twist> Search::twists_at(const Node& node) {
  const Eigen::Vector3d center = node.state.bodies[0].pose * bodies_[0].center;
  const double arm = world_->torque_arm(0);
  std::vector<Contact> contacts;
  world_->contacts(node.state, contacts);
  std::vector<Twist> slips = geometry::slippable_motions(touching_surfaces(contacts, query_.scene.moving), center, arm);
  if (slips.empty()) {
    add_contacts_of_pushes(node.state, contacts);
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

/// Wrenches that drive the bodies from `state` along a screw. They rotate with the bodies.
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

/// At the start of the query, every motion that the contacts guide has a rotation, and one of them separates the part.
/// False without further tests for parts that touch nothing or can translate.
bool Search::screw_leads_out() {
  const State start = world_->initial_state();
  const Eigen::Vector3d center = start.bodies[0].pose * bodies_[0].center;
  const double arm = world_->torque_arm(0);
  std::vector<Contact> contacts;
  world_->contacts(start, contacts);
  const std::vector<Twist> guided =
      geometry::guided_motions(touching_surfaces(contacts, query_.scene.moving), center, arm);
  if (std::any_of(guided.begin(), guided.end(), [](const Twist& t) { return t.angular.isZero(0); })) return false;
  return std::any_of(guided.begin(), guided.end(), [&](const Twist& t) {
    return std::isfinite(way_out(start, t, center)) || std::isfinite(way_out(start, {-t.linear, -t.angular}, center));
  });
}

/// Rotations that the contacts allow, with pressure along their axes in both directions, to find a slot there.
std::vector<Action> Search::leaning_turns(const Node& node) {
  std::vector<Action> actions;
  for (const Twist& twist : twists_at(node)) {
    if (twist.angular.norm() * world_->torque_arm(0) < twist.linear.norm()) continue;
    const Eigen::Vector3d axis = twist.angular.normalized();
    for (const double sign : {1.0, -1.0}) actions.push_back(along(twist, node.state, sign * tactics_.lean * axis));
  }
  return actions;
}

}  // namespace dismantle::push
