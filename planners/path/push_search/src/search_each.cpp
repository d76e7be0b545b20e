// Where each part moves in its own way, until one of them is out.
#include <algorithm>

#include "dismantle/push/search.h"

namespace dismantle::push {

/// Is one part separated from all others, or, without a goal of single parts, the group from the rest?
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

/// Of the centre that came furthest. Each in its own way: of the part that came second furthest, turns included; where
/// that is nothing, one part has moved alone.
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

/// Parts that drive each other rub along their surfaces all the way, which is hard to prove harmless: the same path,
/// smoother, with some room between them wherever there is any. Begin and end stay as they are.
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
