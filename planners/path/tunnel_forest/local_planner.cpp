#include "local_planner.h"

#include <algorithm>

#include "dismantle/search/placed_parts.h"

namespace dismantle::tunnel_forest {

LocalPlanner::LocalPlanner(World& world, const Parameters& parameters, double arrival)
    : world_(world),
      force_(parameters.force),
      push_time_(parameters.push_time),
      stall_(parameters.stall),
      arrival_(arrival),
      idle_pushes_(parameters.idle_pushes),
      bodies_(path::balls_of(world)) {}

double LocalPlanner::distance(const std::vector<Pose>& from, const std::vector<Pose>& to) const {
  double most = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto& b = bodies_[i];
    most = std::max(most, (to[i] * b.center - from[i] * b.center).norm() +
                              (b.radius > 0 ? b.radius * angle_between(from[i].q, to[i].q) : 0.0));
  }
  return most;
}

LocalPlanner::Trajectory LocalPlanner::steer(const State& from, const std::vector<Pose>& target, double range,
                                             const std::function<bool()>& stop) {
  Trajectory trajectory;
  trajectory.end = from;
  double left = distance(path::poses_of(trajectory.end), target), best = left;
  std::int64_t idle = 0;
  for (int push = 0; push < 1000; ++push) {  // limits bodies that creep
    trajectory.arrived = left < arrival_;
    if (trajectory.arrived || trajectory.length >= range || stop()) return trajectory;
    // Speed is proportional to force, so a push near the target is weakened to travel just the remaining distance.
    const double share = free_push_ > 0 ? std::min(1.0, left / free_push_) : 1.0;
    Action action;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      BodyState& body = trajectory.end.bodies[i];
      body.velocity.setZero();
      body.angular_velocity.setZero();
      const double f = share * force_ / left, radius = bodies_[i].radius;
      Wrench wrench;
      wrench.force = f * (target[i] * bodies_[i].center - body.pose * bodies_[i].center);
      if (radius > 0) {
        const Eigen::Quaterniond turn = (target[i].q * body.pose.q.conjugate()).normalized();
        wrench.torque = f * world_.torque_arm(i) * radius * rotation_vector(turn);
      }
      action.wrenches.push_back(wrench);
    }
    const State before = trajectory.end;
    const std::size_t instants = trajectory.path.size();
    const StepReport report = world_.advance(trajectory.end, action, push_time_, &trajectory.path);
    steps_ += std::max<std::uint64_t>(report.steps, 1);
    if (!report.finite) {
      trajectory.end = before;
      trajectory.path.resize(instants);
      return trajectory;
    }
    trajectory.length += report.travel;
    const double was = left;
    left = distance(path::poses_of(trajectory.end), target);
    // A push straight towards the target met no obstacle. Travel alone does not show that, because bodies in
    // penetration are thrown out further than any push moves them.
    if (share == 1 && was - left > (1 - stall_) * report.travel) free_push_ = std::max(free_push_, report.travel);
    const double free = share * free_push_;
    if (report.travel < stall_ * free) {
      trajectory.blocked = true;
      trajectory.arrived = left < arrival_;
      return trajectory;
    }
    if (left < best - 0.5 * stall_ * free) {
      best = left;
      idle = 0;
    } else if (++idle >= idle_pushes_) {
      trajectory.blocked = true;
      return trajectory;
    }
  }
  return trajectory;
}

}  // namespace dismantle::tunnel_forest
