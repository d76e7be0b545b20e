#include "dismantle/push_search/problem.h"

#include <algorithm>
#include <limits>

namespace dismantle::push {

Problem::Problem(const PathQuery& asked, MotionSpace space, const Tactics& with)
    : query(asked),
      tactics(with),
      world(query.simulator.world(query.assembly, query.prepared, query.scene, space)),
      bodies(path::balls_of(*world)),
      axes(tactics.own_axes ? own_axes(query.assembly, query.scene, tactics.facet_angle) : Eigen::Matrix3d::Identity()),
      extents(query.assembly, query.scene, axes) {}

const std::vector<Stage>& Problem::stages() const {
  if (independent()) return tactics.independent;
  return rotates() ? tactics.rotating : tactics.translating;
}

bool Problem::out(const State& state) const {
  if (!independent()) return world->separated(state);
  const auto& leaving = query.goal.any_of;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (std::find(leaving.begin(), leaving.end(), query.scene.moving[i].part) != leaving.end() &&
        world->body_separated(state, i))
      return true;
  return false;
}

double Problem::displacement(const State& state) const {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Pose& start = query.scene.moving[i].pose;
    const Pose& now = state.bodies[i].pose;
    lengths.push_back((now * bodies[i].center - start * bodies[i].center).norm());
    if (independent()) lengths.back() += bodies[i].radius * angle_between(now.q, start.q);
  }
  std::sort(lengths.begin(), lengths.end());
  return independent() ? lengths[lengths.size() - 2] : lengths.back();
}

bool Problem::moved_relatively(const State& from, const State& to) const {
  if (!independent()) return false;
  const double far = tactics.end_similarity * tactics.similarity_translation;
  const auto moved = [&](std::size_t i, const Pose& before, const Pose& after) {
    return screw_travel(before, after, bodies[i].center, bodies[i].radius) > far;
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Pose &before = from.bodies[i].pose, &after = to.bodies[i].pose;
    if (!moved(i, before, after)) continue;
    for (std::size_t k = 0; k < i; ++k) {
      const Pose &was = from.bodies[k].pose, &is = to.bodies[k].pose;
      if (moved(k, was, is) && moved(i, was.inverse() * before, is.inverse() * after)) return true;
    }
  }
  return false;
}

void Problem::give_room(State& state) const {
  const double wanted = tactics.clearance * query.tolerance;
  world->project_to_clearance(state, wanted > 0 ? wanted : std::numeric_limits<double>::infinity());
}

void Problem::move_off_contacts(State& state) const { world->project_to_clearance(state, query.tolerance); }

std::vector<Contact> Problem::contacts(const State& state) const {
  std::vector<Contact> contacts;
  world->contacts(state, contacts);
  return contacts;
}

}  // namespace dismantle::push
