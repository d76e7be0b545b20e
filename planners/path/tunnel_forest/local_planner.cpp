#include "guide.h"

#include <algorithm>

#include "dismantle/path/placed_parts.h"

namespace dismantle::tunnel_forest {
namespace {

/// Nearer than this is there (assembly units): a motion over it may penetrate by half as much.
constexpr double kArrived = 2e-3;
/// A push that moves nothing by more than this share of a free one has met something.
constexpr double kStuck = 0.02;
/// So many pushes in a row may bring the bodies no nearer: around a corner the way is longer.
constexpr int kPatience = 2;
/// A push was free when so much of its travel (share) brought the bodies nearer.
constexpr double kStraight = 0.98;
constexpr double kNearer = 0.01;  ///< of a free push
constexpr int kMostPushes = 1000;

}  // namespace

Guide::Guide(World& world, const Parameters& parameters)
    : world_(world), force_(parameters.force), push_time_(parameters.push_time), bodies_(path::balls_of(world)) {}

double Guide::distance(const std::vector<Pose>& from, const std::vector<Pose>& to) const {
  double most = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto& b = bodies_[i];
    most = std::max(most, (to[i] * b.center - from[i] * b.center).norm() +
                              (b.radius > 0 ? b.radius * angle_between(from[i].q, to[i].q) : 0.0));
  }
  return most;
}

Guide::Trip Guide::go(const State& from, const std::vector<Pose>& target, double range,
                      const std::function<bool()>& stop) {
  Trip trip;
  trip.end = from;
  double left = distance(path::poses_of(trip.end), target), best = left;
  int idle = 0;
  for (int push = 0; push < kMostPushes; ++push) {
    trip.arrived = left < kArrived;
    if (trip.arrived || trip.length >= range || stop()) return trip;
    // Near the target a weaker push goes just as far as is left, where speed follows force.
    const double share = reach_ > 0 ? std::min(1.0, left / reach_) : 1.0;
    Action action;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      BodyState& body = trip.end.bodies[i];
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
    const State before = trip.end;
    const std::size_t instants = trip.way.size();
    const StepReport report = world_.advance(trip.end, action, push_time_, &trip.way);
    steps_ += std::max<std::uint64_t>(report.steps, 1);
    if (!report.finite) {
      trip.end = before;
      trip.way.resize(instants);
      return trip;
    }
    trip.length += report.travel;
    const double was = left;
    left = distance(path::poses_of(trip.end), target);
    // Straight to the target: nothing was in the way. Pushed out of something, bodies jump further than any push goes.
    if (share == 1 && was - left > kStraight * report.travel) reach_ = std::max(reach_, report.travel);
    const double free = share * reach_;
    if (report.travel < kStuck * free) {
      trip.blocked = true;
      trip.arrived = left < kArrived;
      return trip;
    }
    if (left < best - kNearer * free) {
      best = left;
      idle = 0;
    } else if (++idle >= kPatience) {
      trip.blocked = true;
      return trip;
    }
  }
  return trip;
}

}  // namespace dismantle::tunnel_forest
