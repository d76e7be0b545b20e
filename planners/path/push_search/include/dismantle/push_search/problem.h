/// What a push search is asked, and the world that it simulates.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "dismantle/push_search/frame.h"
#include "dismantle/push_search/tactics.h"

namespace dismantle::push {

struct Problem {
  /// Both references must outlive this.
  Problem(const PathQuery& query, MotionSpace space, const Tactics& tactics);

  bool rotates() const { return world->space() == MotionSpace::rigid; }
  /// The parts move independently until one of Goal::any_of is separated.
  bool independent() const { return !query.goal.any_of.empty(); }
  /// Stages of actions of this search.
  const std::vector<Stage>& stages() const;
  /// True if a part of Goal::any_of is separated from all others or, without any_of, the group from the fixed parts.
  bool out(const State& state) const;
  /// Displacement of the centre that has moved furthest. If parts move independently: of the part that has moved second
  /// furthest, rotation included; 0 if only one part has moved.
  double displacement(const State& state) const;
  /// Two parts that move independently have moved, also relative to each other, by more than ends of runs differ.
  bool moved_relatively(const State& from, const State& to) const;
  /// Centre of the first moving part, world frame.
  Eigen::Vector3d center(const State& state) const { return state.bodies[0].pose * bodies[0].center; }
  std::vector<Contact> contacts(const State& state) const;

  // Lengths, assembly units.
  /// Parts without vertices, as in tests, have no way out of each other's boxes.
  double glide_step() const {
    const double longest = extents.longest_exit();
    return std::isfinite(longest) ? std::max(query.tolerance, tactics.glide_step * longest) : 20 * query.tolerance;
  }
  double thinning() const { return tactics.thinning * query.tolerance; }
  /// Moves the parts away from their contacts; see SearchParameters::clearance.
  void give_room(State& state) const;
  /// Moves the parts off each other by what the verifier tolerates, where there is room. Poses that follow each other
  /// stay so near that the motion between them keeps off, too, which is not so in the middle of the room.
  void move_off_contacts(State& state) const;
  double touch_distance() const { return tactics.touch_distance * query.tolerance; }

  const PathQuery& query;
  const Tactics& tactics;
  std::unique_ptr<World> world;
  std::vector<path::Ball> bodies;
  Eigen::Matrix3d axes;  ///< columns: directions of the unit actions
  Extents extents;       ///< at the start of the query
};

}  // namespace dismantle::push
