// Macro motions: a screw is followed by geometry alone as far as it is clear, and corrected where it meets a surface.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/path/placed_parts.h"
#include "dismantle/push/screw_fit.h"
#include "dismantle/push/search.h"

namespace dismantle::push {
namespace {

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

/// Length over which the part penetrates nothing. `clear`: length that was clear on a similar screw.
/// `origin`: state in which the run began. States similar to it or to `start` count as known only after the part has
/// left both.
Search::Stretch Search::glide(const Twist& twist, const State& start, const State& origin, double clear,
                              std::uint32_t first) {
  const Eigen::Vector3d center = start.bodies[0].pose * bodies_[0].center;
  // A long step may miss a thin obstacle. The verifier finds it, and from then on steps do not grow.
  const double growth = short_glides_ ? 0 : tactics_.glide_growth;
  double way = 0, wall = std::numeric_limits<double>::infinity();
  bool left_origin = false;
  while (true) {
    if (out_of_budget()) return {GlideEnd::stop, way};
    const double step = std::min(std::max(glide_step(), growth * std::max(way, clear)), 0.5 * (wall - way));
    if (step < query_.tolerance) return {GlideEnd::blocked, way};
    ++state_checks_;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min<std::uint64_t>(*limits_.steps_left, 1);
    if (world_->penetration(moved(start, twist, center, way + step)) > touch_distance()) {
      wall = way + step;
      continue;
    }
    // Separation and known states are tested at short distances in long steps, too: a bent tube may lead back in.
    const int pieces = static_cast<int>(std::ceil(step / glide_step()));
    for (int k = 1; k <= pieces; ++k) {
      const double along = way + k * step / pieces;
      const State there = moved(start, twist, center, along);
      if (world_->separated(there)) return {GlideEnd::out, along};
      left_origin = left_origin || (!seen_.similar(there, start) && !seen_.similar(there, origin));
      if (left_origin && seen_.has_similar(there, first, static_cast<std::uint32_t>(nodes_.size())))
        return {GlideEnd::known, along};
    }
    way += step;
  }
}

/// Moves the run along the screw. Instants and states are recorded at short distances, whatever the steps of glide().
void Search::record(const Twist& twist, double way, unsigned depth, Run& run) {
  const State start = run.state;
  const Eigen::Vector3d center = start.bodies[0].pose * bodies_[0].center;
  State last = start;
  const int instants = static_cast<int>(std::ceil(way / glide_step()));
  for (int k = 1; k <= instants; ++k) {
    const double along = way * k / instants;
    run.state = moved(start, twist, center, along);
    run.way.push_back(path::poses_of(run.state));
    if (seen_.similar(run.state, last)) continue;
    last = run.state;
    run.last = add_node(run.last, depth, run.state, std::move(run.way), true);
    run.way.clear();
    if (tactics_.intermediate > 0) enqueue(run.last);
  }
  run.length += way;
}

/// Follows a screw. Where it is blocked, the part goes back a little and is moved away from its contacts. The screw is
/// fitted to that pose, and the part restarts from its first pose: a thread is one screw, which the verifier proves
/// with the least effort. If the new screw leads no further, the surface has no single screw (a bent tube), and the
/// curve is followed piece by piece. The rest is simulated with a wrench that rotates with the part.
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
  world_->project_to_clearance(run.state, clearance());
  run.way.push_back(path::poses_of(run.state));
  State room = run.state, stuck = run.state;
  twist = about(twist, center_of(origin), center_of(run.state));
  Twist best_twist = twist, from_room = twist;
  double best = 0;  // longest clear length of the screws from run.state
  while (true) {
    const Stretch glided = glide(twist, run.state, origin, best, first);
    if (glided.end == GlideEnd::stop) return RunEnd::stop;
    if (glided.end != GlideEnd::blocked) {
      record(twist, glided.way, depth, run);
      if (glided.end == GlideEnd::known) return RunEnd::blocked;
      const RunEnd verified = verify(add_node(run.last, depth, run.state, std::move(run.way), false), origin, result);
      if (verified == RunEnd::refused || verified == RunEnd::refused_learned) short_glides_ = true;
      return verified;
    }
    const Eigen::Vector3d center = center_of(run.state);
    if (glided.way > best + glide_step()) {
      best = glided.way;
      best_twist = twist;
      const State on_screw = moved(run.state, twist, center, tactics_.glide_kept * best);
      room = on_screw;
      world_->project_to_clearance(room, clearance());
      from_room =
          fitted_screw(about(twist, center, center_of(room)), run.state.bodies[0].pose, room.bodies[0].pose,
                       bodies_[0].center, world_->torque_arm(0), tactics_.glide_kept * best * twist.angular.norm());
      twist = about(from_room, center_of(room), center);
      // Without a correction the screw was right, and something else is in the way.
      if (travel(on_screw, room) > touch_distance()) continue;
      break;
    }
    if (best == 0) best = glided.way;
    const State end = moved(run.state, best_twist, center, best);
    if (travel(stuck, end) < glide_step()) break;
    stuck = end;
    record(best_twist, tactics_.glide_kept * best, depth, run);
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
