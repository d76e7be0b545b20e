// Macro motions: a screw is followed by geometry alone as far as it leads, and corrected where it runs into a surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dismantle/path/placed_parts.h"
#include "dismantle/push/screw_fit.h"
#include "dismantle/push/search.h"

namespace dismantle::push {
namespace {

/// Distance between two checks of penetration on a screw: as it begins, the longest that it grows to in the first turn,
/// and the shortest tried before giving up (assembly units). What is thinner than a step may be jumped; the verifier
/// sees it, and from then on steps do not grow.
constexpr double kGlideStep = 0.1, kMostGlideStep = 2.4, kLeastGlideStep = 0.0125;
/// Steps grow to this share of the way that was clear. After one full turn every
/// side of the part has passed every side of its guide: from then on steps are shares of a turn, and the end of the motion is
/// found to a share of it.
constexpr double kGlideShare = 0.125, kTurnsShare = 0.25, kEndShare = 1.0 / 32;
/// Penetration that counts as none, as a share of the tolerance.
constexpr double kGlideDepthShare = 0.1;
/// The room that a part is given before it glides on; assembly units.
constexpr double kGlideClearance = 0.02;
/// A glide that covers less is not worth another one.
constexpr double kLeastGlide = 0.15;
/// What is kept of a glide that got stuck.
constexpr double kKept = 0.75;
/// Distance between two checks of separation and of known states.
constexpr double kGlideLook = 0.3;

State moved(const State& start, const Twist& twist, const Eigen::Vector3d& center, double way) {
  State there = start;
  for (auto& b : there.bodies) b.pose = geometry::moved_along(b.pose, twist, center, way);
  return there;
}

/// The same motion, given by the velocity of another point.
Twist about(const Twist& twist, const Eigen::Vector3d& was, const Eigen::Vector3d& is) {
  return {twist.linear + twist.angular.cross(is - was), twist.angular};
}

}  // namespace

/// How far nothing is entered. `clear`: so far a screw much like this one was clear.
Search::Stretch Search::glide(const Twist& twist, const State& start, double clear, std::uint32_t first) {
  const Eigen::Vector3d center = start.bodies[0].pose * bodies_[0].center;
  const double turn =
      twist.angular.isZero(0) ? std::numeric_limits<double>::infinity() : 2 * std::numbers::pi / twist.angular.norm();
  const auto longest_step = [&](double way) {
    if (short_glides_) return kGlideStep;
    return std::max(kGlideStep, way > turn ? kTurnsShare * way : std::min(kMostGlideStep, kGlideShare * way));
  };
  double way = 0, asked = 0, wall = std::numeric_limits<double>::infinity();
  bool left_start = false;
  while (true) {
    if (out_of_budget()) return {GlideEnd::stop, way};
    const double step = std::min(longest_step(std::max(way, clear)), 0.5 * (wall - way));
    if (step < std::max(kLeastGlideStep, way > turn ? kEndShare * way : 0)) return {GlideEnd::blocked, way};
    ++looks_;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min<std::uint64_t>(*limits_.steps_left, 1);
    if (world_->penetration(moved(start, twist, center, way + step)) > kGlideDepthShare * query_.tolerance) {
      wall = way + step;
      continue;
    }
    // All else is asked as often as if every step had been short.
    const int pieces = std::max(1, static_cast<int>(std::ceil(step / kGlideLook - 1e-9)));
    for (int k = 1; k <= pieces; ++k) {
      const double along = way + k * step / pieces;
      const State there = moved(start, twist, center, along);
      const bool ask = along >= asked + (way > turn ? kMostGlideStep : kGlideLook) * (1 - 1e-9);
      if (ask) asked = along;
      if (ask && world_->separated(there)) return {GlideEnd::out, along};
      left_start = left_start || !seen_.similar(there, start);
      if (left_start && seen_.has_similar(there, first, static_cast<std::uint32_t>(nodes_.size())))
        return {GlideEnd::known, along};
    }
    way += step;
  }
}

/// Moves the run along the screw. Instants and states are as dense as if every step had been short.
void Search::record(const Twist& twist, double way, unsigned depth, Run& run) {
  const State start = run.state;
  const Eigen::Vector3d center = start.bodies[0].pose * bodies_[0].center;
  State last = start;
  double noted = 0;
  const int instants = static_cast<int>(std::ceil(way / kGlideStep - 1e-9));
  for (int k = 1; k <= instants; ++k) {
    const double along = way * k / instants;
    run.state = moved(start, twist, center, along);
    run.way.push_back(path::poses_of(run.state));
    if (along < noted + kGlideLook * (1 - 1e-9) || seen_.similar(run.state, last)) continue;
    noted = along;
    last = run.state;
    run.last = add_node(run.last, depth, run.state, std::move(run.way), true);
    run.way.clear();
    if (tactics_.intermediate > 0) enqueue(run.last);
  }
  run.length += way;
}

/// Follows a screw. Where the way ends, the part is put in the middle of its room a little before, which tells the
/// screw better, and it starts again from where it began: one screw for all of the way is what a thread is, and what
/// the verifier proves with least effort. Where that leads no further the surface has no screw of its own, as a bent
/// tube: the curve is followed from there by a screw for each piece. What remains is simulated with a wrench that turns
/// along.
Search::RunEnd Search::follow_screw(std::int32_t from, Twist twist, unsigned depth, PathResult& result) {
  const State origin = nodes_[static_cast<std::size_t>(from)].state;
  const auto travel = [&](const State& a, const State& b) {
    return screw_travel(a.bodies[0].pose, b.bodies[0].pose, bodies_[0].center, world_->radius(0));
  };
  const auto center_of = [&](const State& s) -> Eigen::Vector3d { return s.bodies[0].pose * bodies_[0].center; };
  Run run;
  run.state = origin;
  run.last = from;
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  world_->project_to_clearance(run.state, kGlideClearance);
  run.way.push_back(path::poses_of(run.state));
  State room = run.state, stuck = run.state;
  twist = about(twist, center_of(origin), center_of(run.state));
  Twist best_twist = twist, from_room = twist;
  double best = 0;  // of all screws from run.state
  while (true) {
    const Stretch glided = glide(twist, run.state, best, first);
    if (glided.end == GlideEnd::stop) return RunEnd::stop;
    if (glided.end != GlideEnd::blocked) {
      record(twist, glided.way, depth, run);
      if (glided.end == GlideEnd::known) return RunEnd::blocked;
      const RunEnd verified = verify(add_node(run.last, depth, run.state, std::move(run.way), false), origin, result);
      if (verified == RunEnd::refused || verified == RunEnd::refused_learned) short_glides_ = true;
      return verified;
    }
    const Eigen::Vector3d center = center_of(run.state);
    if (glided.way > best + kLeastGlide) {
      best = glided.way;
      best_twist = twist;
      const State on_screw = moved(run.state, twist, center, kKept * best);
      room = on_screw;
      world_->project_to_clearance(room, kGlideClearance);
      from_room = fitted_screw(about(twist, center, center_of(room)), run.state.bodies[0].pose, room.bodies[0].pose,
                               bodies_[0].center, world_->torque_arm(0), kKept * best * twist.angular.norm());
      twist = about(from_room, center_of(room), center);
      // Where the screw was right, something else is in the way.
      if (travel(on_screw, room) > kGlideDepthShare * query_.tolerance) continue;
      break;
    }
    if (best == 0) best = glided.way;
    const State end = moved(run.state, best_twist, center, best);
    if (travel(stuck, end) < kLeastGlide) break;
    stuck = end;
    record(best_twist, kKept * best, depth, run);
    run.state = room;
    run.way.push_back(path::poses_of(run.state));
    best = 0;
    best_twist = twist = from_room;
  }
  const Eigen::Vector3d begun = center_of(run.state);
  record(best_twist, best, depth, run);
  if (!run.way.empty() && run.length > 0) {
    if (fine_.has_similar(run.state) && run.last != from) return RunEnd::blocked;
    run.last = add_node(run.last, depth, run.state, std::move(run.way), false);
  }
  return follow(run.last, along(about(best_twist, begun, center_of(run.state)), run.state), Stage::twists, depth,
                result);
}

}  // namespace dismantle::push
