// Searches in which parts move independently until one of them is separated.
#include <algorithm>

#include "dismantle/push/search.h"

namespace dismantle::push {

/// True if a part of Goal::any_of is separated from all others or, without any_of, the group from the fixed parts.
bool Search::out(const State& state) {
  if (query_.goal.any_of.empty()) return world_->separated(state);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto& leaving = query_.goal.any_of;
    if (std::find(leaving.begin(), leaving.end(), query_.scene.moving[i].part) != leaving.end() &&
        world_->body_separated(state, i))
      return true;
  }
  return false;
}

/// Displacement of the centre that has moved furthest. If parts move independently: of the part that has moved second
/// furthest, rotation included; 0 if only one part has moved.
double Search::way_from_start(const State& state) const {
  std::vector<double> ways;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Pose& start = query_.scene.moving[i].pose;
    const Pose& now = state.bodies[i].pose;
    ways.push_back((now * bodies_[i].center - start * bodies_[i].center).norm());
    if (!query_.goal.any_of.empty()) ways.back() += bodies_[i].radius * angle_between(now.q, start.q);
  }
  std::sort(ways.begin(), ways.end());
  return query_.goal.any_of.empty() ? ways.back() : ways[ways.size() - 2];
}

/// The same path, thinned, with clearance between the parts wherever possible: parts that drive each other stay in
/// contact along the whole path, which is hard to verify. The first and the last instant do not change.
Path Search::with_room(const Path& rubbing) {
  Path path = path::thin(rubbing, bodies_, touch_distance());
  for (std::size_t k = 1; k + 1 < path.size() && !out_of_budget(); ++k) {
    State state = world_->initial_state();
    for (std::size_t i = 0; i < bodies_.size(); ++i) state.bodies[i].pose = path[k][i];
    world_->project_to_clearance(state, clearance());
    for (std::size_t i = 0; i < bodies_.size(); ++i) path[k][i] = state.bodies[i].pose;
  }
  return path;
}

}  // namespace dismantle::push
