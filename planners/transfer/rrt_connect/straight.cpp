#include "straight.h"

#include <algorithm>
#include <limits>

namespace dismantle::rrt_connect {
namespace {

using Eigen::Vector3d;

constexpr double kRigid = 1e-7;  // assembly units

/// Ball around all that moves, at the start.
struct Ball {
  Vector3d center = Vector3d::Zero();
  double radius = 0;
};

Ball ball_of(const TransferQuery& query) {
  Aabb box;
  const auto each = [&](const auto& visit) {
    for (const auto& m : query.scene.moving)
      for (const auto& v : query.assembly.parts[m.part].mesh->vertices) visit(m.pose * v);
  };
  each([&](const Vector3d& p) { box.extend(p); });
  Ball ball{box.center(), 0};
  each([&](const Vector3d& p) { ball.radius = std::max(ball.radius, (p - ball.center).norm()); });
  return ball;
}

/// How far things reach in direction `v`.
double reach(const Assembly& assembly, const std::vector<PlacedPart>& parts, const Pose& displacement,
             const Vector3d& v) {
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& p : parts) {
    const Pose pose = displacement * p.pose;
    for (const auto& x : assembly.parts[p.part].mesh->vertices) most = std::max(most, v.dot(pose * x));
  }
  return most;
}

Pose shift(const Vector3d& way) { return {way, Eigen::Quaterniond::Identity()}; }

}  // namespace

bool displacement_to_goal(const TransferQuery& query, Pose& displacement) {
  const auto& moving = query.scene.moving;
  if (moving.empty() || query.goal.size() != moving.size()) return false;
  displacement = query.goal[0] * moving[0].pose.inverse();
  for (std::size_t i = 1; i < moving.size(); ++i) {
    const Pose there = displacement * moving[i].pose;
    if ((there.t - query.goal[i].t).norm() > kRigid || angle_between(there.q, query.goal[i].q) > kRigid) return false;
  }
  return true;
}

std::vector<Path> straight_ways(const TransferQuery& query, double clearance) {
  Pose goal;
  if (!displacement_to_goal(query, goal)) return {};
  const Ball ball = ball_of(query);
  const bool turns = angle_between(goal.q, Eigen::Quaterniond::Identity()) > 1e-9;
  const Vector3d there = goal * ball.center;

  const auto path_of = [&](const std::vector<Pose>& displacements) {
    Path path;
    for (const auto& d : displacements) {
      path.emplace_back();
      for (const auto& m : query.scene.moving) path.back().push_back(d * m.pose);
    }
    path.back() = query.goal;
    return path;
  };
  const auto over = [&](const Vector3d& v) {
    // A group that turns takes the room of its ball; one that does not, only its own.
    const double own_start = -reach(query.assembly, query.scene.moving, {}, -v);
    const double own_goal = -reach(query.assembly, query.scene.moving, goal, -v);
    const double lowest_start = turns ? v.dot(ball.center) - ball.radius : own_start;
    const double lowest_goal = turns ? v.dot(there) - ball.radius : own_goal;
    const double top = reach(query.assembly, query.scene.fixed, {}, v) + clearance;
    // Heights of the ball's centre that clear everything, and are not below either end.
    const double height = std::max(
        {v.dot(ball.center) + std::max(0.0, top - lowest_start), v.dot(there) + std::max(0.0, top - lowest_goal)});
    const Pose lifted = shift((height - v.dot(ball.center)) * v);
    const Pose above = shift((height - v.dot(there)) * v) * goal;
    const Vector3d c = lifted * ball.center;
    const Pose turned{c - goal.q * ball.center, goal.q};
    return path_of({Pose{}, lifted, turned, above, goal});
  };

  std::vector<Path> ways;
  const Vector3d up = query.up;
  if (!query.scene.fixed.empty()) ways.insert(ways.end(), {over(up), over(-up)});
  const Pose turned{ball.center - goal.q * ball.center, goal.q};
  ways.push_back(path_of({Pose{}, turned, goal}));
  if (query.scene.fixed.empty()) return ways;
  const Vector3d side = up.unitOrthogonal();
  for (const Vector3d& v : {side, Vector3d(-side), Vector3d(up.cross(side)), Vector3d(-up.cross(side))})
    ways.push_back(over(v));
  return ways;
}

}  // namespace dismantle::rrt_connect
