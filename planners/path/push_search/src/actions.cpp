#include "dismantle/push_search/actions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dismantle/search/placed_parts.h"

namespace dismantle::push {
namespace {

using Vec3 = Eigen::Vector3d;

/// `torque` for a body of unit torque arm.
Action turn(const World& world, const Vec3& torque, const Vec3& force) {
  Action a;
  for (std::size_t i = 0; i < world.scene().moving.size(); ++i)
    a.wrenches.push_back({force, world.torque_arm(i) * torque});
  return a;
}

}  // namespace

Action push(const World& world, double force, const Vec3& direction) {
  Action a;
  const Wrench wrench{force * direction.normalized(), Vec3::Zero()};
  a.wrenches.assign(world.scene().moving.size(), wrench);
  return a;
}

std::vector<Action> unit_actions(const World& world, double force, bool turns, const Eigen::Matrix3d& axes) {
  std::vector<Action> actions;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) actions.push_back(push(world, force, sign * axes.col(axis)));
  if (!turns) return actions;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) actions.push_back(turn(world, sign * force * axes.col(axis), Vec3::Zero()));
  return actions;
}

std::vector<Action> screw_actions(const World& world, double force, const Eigen::Matrix3d& axes) {
  std::vector<Action> actions;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      for (const double pull : {1.0, -1.0})
        actions.push_back(turn(world, sign * force * axes.col(axis), pull * force * axes.col(axis)));
  return actions;
}

namespace {

/// Gives body i a force or a torque along `axis`.
void drive(Action& action, const World& world, std::size_t i, bool turns, const Vec3& axis) {
  Wrench& wrench = action.wrenches[i];
  (turns ? wrench.torque : wrench.force) = turns ? Vec3(world.torque_arm(i) * axis) : axis;
}

Action at_rest(const World& world) {
  Action action;
  action.wrenches.resize(world.scene().moving.size());
  return action;
}

}  // namespace

std::vector<Action> one_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes) {
  std::vector<Action> actions;
  for (const bool torque : {false, true})
    for (std::size_t i = 0; i < world.scene().moving.size() && (turns || !torque); ++i)
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          actions.push_back(at_rest(world));
          drive(actions.back(), world, i, torque, sign * force * axes.col(axis));
        }
  return actions;
}

std::vector<Action> two_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes, bool across) {
  std::vector<Action> actions;
  const std::size_t n = world.scene().moving.size();
  const int kinds = turns ? 4 : 1;  // forces, or a force and a torque either way, or torques
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          if ((a != b) != across) continue;
          for (int kind = 0; kind < kinds; ++kind)
            for (const double first : {1.0, -1.0})
              for (const double second : {1.0, -1.0}) {
                actions.push_back(at_rest(world));
                drive(actions.back(), world, i, (kind & 1) != 0, first * force * axes.col(a));
                drive(actions.back(), world, j, (kind & 2) != 0, second * force * axes.col(b));
              }
        }
  return actions;
}

std::vector<Action> diagonal_actions(const World& world, double force, const Eigen::Matrix3d& axes) {
  std::vector<Action> actions;
  for (int weight = 3; weight >= 2; --weight)  // space diagonals first: they reach all three axes
    for (int x = 1; x >= -1; --x)
      for (int y = 1; y >= -1; --y)
        for (int z = 1; z >= -1; --z)
          if (std::abs(x) + std::abs(y) + std::abs(z) == weight)
            actions.push_back(push(world, force, axes * Vec3(x, y, z)));
  return actions;
}

Freedom freedom_of(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving, const Extents& extents,
                   const ProposalParameters& parameters) {
  const double same = std::cos(parameters.facet_angle), into = std::sin(parameters.facet_angle);
  const auto most = static_cast<std::size_t>(parameters.free_directions);
  struct Cluster {
    Vec3 normal;
    std::size_t count;
  };
  std::vector<Cluster> clusters;
  for (const Contact& c : contacts) {
    if (c.on_edge || path::contains(moving, c.other)) continue;
    const auto known =
        std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& k) { return k.normal.dot(c.normal) > same; });
    if (known != clusters.end())
      ++known->count;
    else
      clusters.push_back({c.normal, 1});
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.count > b.count; });
  if (clusters.size() > 2 * most) clusters.resize(2 * most);  // two normals make a direction
  Freedom freedom;
  for (const Cluster& c : clusters) freedom.normals.push_back(c.normal);

  const auto& n = freedom.normals;
  const auto propose = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (length < into) return;  // parallel normals
    const Vec3 d = direction / length;
    for (const Vec3& normal : n)
      if (normal.dot(d) < -into) return;
    for (const Vec3& known : freedom.directions)
      if (known.dot(d) > same) return;
    freedom.directions.push_back(d);
  };
  for (std::size_t i = 0; i < n.size(); ++i)
    for (std::size_t j = i + 1; j < n.size(); ++j) {
      const Vec3 along = n[i].cross(n[j]);
      propose(along);
      propose(-along);
    }
  for (const Vec3& normal : n) propose(normal);
  std::stable_sort(freedom.directions.begin(), freedom.directions.end(), [&](const Vec3& a, const Vec3& b) {
    return extents.exit_distance(a) < extents.exit_distance(b) - 1e-9;
  });
  if (freedom.directions.size() > most) freedom.directions.resize(most);
  return freedom;
}

std::vector<Vec3> leaning(const Freedom& freedom, double lean) {
  std::vector<Vec3> directions;
  for (const Vec3& d : freedom.directions)
    for (const Vec3& n : freedom.normals)
      if (d.dot(n) < lean)  // else the push leads away from the wall
        directions.push_back((d - lean * n).normalized());
  return directions;
}

}  // namespace dismantle::push
