#include "dismantle/push_search/screw_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dismantle/push_search/screw_fit.h"
#include "dismantle/search/placed_parts.h"

namespace dismantle::push {
namespace {

using geometry::Twist;

State moved(const State& start, const Twist& screw, const Eigen::Vector3d& center, double length) {
  State there = start;
  for (auto& b : there.bodies) b.pose = geometry::moved_along(b.pose, screw, center, length);
  return there;
}

/// The same motion, given by the velocity of another point.
Twist about(const Twist& screw, const Eigen::Vector3d& was, const Eigen::Vector3d& is) {
  return {screw.linear + screw.angular.cross(is - was), screw.angular};
}

}  // namespace

ScrewRun::ScrewRun(Problem& problem, Work& work, StateTree& tree, std::int32_t from, unsigned depth, bool short_glides)
    : problem_(problem),
      work_(work),
      tree_(tree),
      from_(from),
      depth_(depth),
      // A long step may miss a thin obstacle. The verifier finds it, and from then on steps do not grow.
      growth_(short_glides ? 0 : problem.tactics.glide_growth),
      first_(tree.size()),
      origin_(tree[from].state),
      state_(origin_),
      last_(from) {
  problem_.give_room(state_);
  motion_.push_back(path::poses_of(state_));
  room_ = state_;
}

double ScrewRun::travel(const State& a, const State& b) const {
  return screw_travel(a.bodies[0].pose, b.bodies[0].pose, problem_.bodies[0].center, problem_.world->radius(0));
}

/// The run has come to a state of its own, or of another run. `left`: it has left the states where it and this glide
/// began, which count as known only after that.
bool ScrewRun::in_known_state(const State& state, const State& start, bool& left) const {
  const path::StateSet& seen = tree_.seen();
  left = left || (!seen.similar(state, start) && !seen.similar(state, origin_));
  return left && seen.has_similar(state, first_, tree_.size());
}

/// Length over which the part penetrates nothing. `clear`: length that was clear on a similar screw.
ScrewRun::Glide ScrewRun::glide(const Twist& screw, double clear) {
  const Eigen::Vector3d center = problem_.center(state_);
  const double shortest = problem_.glide_step();
  double length = 0, wall = std::numeric_limits<double>::infinity();
  bool left = false;
  while (true) {
    if (work_.used_up()) return {End::stop, length};
    const double step = std::min(std::max(shortest, growth_ * std::max(length, clear)), 0.5 * (wall - length));
    if (step < problem_.query.tolerance) return {End::blocked, length};
    work_.count_check();
    if (problem_.world->penetration(moved(state_, screw, center, length + step)) > problem_.touch_distance()) {
      wall = length + step;
      continue;
    }
    // Separation and known states are tested at short distances in long steps, too: a bent tube may lead back in.
    const int pieces = static_cast<int>(std::ceil(step / shortest));
    for (int k = 1; k <= pieces; ++k) {
      const double along = length + k * step / pieces;
      const State there = moved(state_, screw, center, along);
      if (problem_.world->separated(there)) return {End::out, along};
      if (in_known_state(there, state_, left)) return {End::known, along};
    }
    length += step;
  }
}

/// Moves the run along the screw. Instants and states are recorded at short distances, whatever the steps of glide().
void ScrewRun::record(const Twist& screw, double length) {
  const State start = state_;
  const Eigen::Vector3d center = problem_.center(start);
  State last = start;
  const int instants = static_cast<int>(std::ceil(length / problem_.glide_step()));
  for (int k = 1; k <= instants; ++k) {
    state_ = moved(start, screw, center, length * k / instants);
    motion_.push_back(path::poses_of(state_));
    if (tree_.seen().similar(state_, last)) continue;
    last = state_;
    last_ = tree_.add(last_, depth_, state_, std::exchange(motion_, {}), true);
    if (problem_.tactics.intermediate > 0) tree_.enqueue(last_);
  }
  length_ += length;
}

/// Moves the part away from its contacts at a length, and fits the screw to that pose. False: that moves it nowhere.
bool ScrewRun::turn_back(double kept) {
  const Eigen::Vector3d center = problem_.center(state_);
  const State on_screw = moved(state_, screw_, center, kept);
  kept_ = kept;
  room_ = on_screw;
  problem_.give_room(room_);
  screw_in_room_ =
      fitted_screw(about(screw_, center, problem_.center(room_)), state_.bodies[0].pose, room_.bodies[0].pose,
                   problem_.bodies[0].center, problem_.world->torque_arm(0), kept * screw_.angular.norm());
  return travel(on_screw, room_) > problem_.touch_distance();
}

ScrewRun::End ScrewRun::follow(const Twist& first) {
  State stuck = state_;
  Twist screw = about(first, problem_.center(origin_), problem_.center(state_));
  screw_ = screw_in_room_ = screw;
  double best = 0;  // longest clear length of the screws from state_
  while (true) {
    const auto [end, length] = glide(screw, best);
    if (end == End::stop) return end;
    if (end != End::blocked) {
      record(screw, length);
      if (end == End::out) last_ = tree_.add(last_, depth_, state_, std::move(motion_), false);
      return end;
    }
    const Eigen::Vector3d center = problem_.center(state_);
    if (length > best + problem_.glide_step()) {
      best = length;
      screw_ = screw;
      // Without a correction, also where it is blocked, the screw was right, and something else is in the way.
      if (!turn_back(problem_.tactics.glide_kept * best) && !turn_back(best)) return finish(best);
      screw = about(screw_in_room_, problem_.center(room_), center);
      continue;
    }
    if (best == 0) best = length;
    const State blocked = moved(state_, screw_, center, best);
    if (travel(stuck, blocked) < problem_.glide_step()) return finish(best);
    stuck = blocked;
    record(screw_, kept_);
    state_ = room_;
    motion_.push_back(path::poses_of(state_));
    best = 0;
    screw_ = screw = screw_in_room_;
  }
}

/// Records the clear length of the best screw.
ScrewRun::End ScrewRun::finish(double length) {
  const Eigen::Vector3d begun = problem_.center(state_);
  record(screw_, length);
  if (!motion_.empty() && length_ > 0) {
    if (tree_.fine().has_similar(state_) && last_ != from_) return End::known;
    last_ = tree_.add(last_, depth_, state_, std::move(motion_), false);
  }
  screw_ = about(screw_, begun, problem_.center(state_));
  return End::blocked;
}

}  // namespace dismantle::push
