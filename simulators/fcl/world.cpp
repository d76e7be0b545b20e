#include "world.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "dismantle/geometry/hull.h"
#include "dismantle/plugin/finite.h"

namespace dismantle::mesh_collision {
MeshWorld::MeshWorld(const PreparedBodies& prepared, const Scene& scene, MotionSpace space,
                     const Parameters& parameters)
    : scene_(scene),
      space_(space),
      depth_limit_(parameters.depth_limit),
      separation_gap_(parameters.resolution),
      check_(parameters) {
  if (scene.moving.empty()) throw std::invalid_argument("a world needs a part that moves");
  const auto member = [&](const PlacedPart& p) {
    const PlacedBody& placed = prepared.placed[p.part];
    const Pose pose = p.pose * placed.rest;
    return Member{p.part, &placed, pose, moved_box(placed.body->box, pose)};
  };
  for (const auto& m : scene.moving) moving_.push_back(member(m));
  for (const auto& s : scene.fixed) fixed_.push_back(member(s));
  for (const auto& m : moving_) {
    for (const auto& s : fixed_) allowed_.push_back(prepared.overlap(m.part, s.part));
    for (const auto& n : moving_) allowed_.push_back(prepared.overlap(m.part, n.part));
  }
  for (const auto& s : fixed_)
    for (const auto& corner : s.placed->body->hull) {
      rest_hull_.push_back(s.pose * corner);
      rest_box_.extend(rest_hull_.back());
    }
}

State MeshWorld::initial_state() const {
  State s;
  for (const auto& m : scene_.moving) s.bodies.push_back({m.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  return s;
}

StepReport MeshWorld::advance(State&, const Action&, double, Trace*) {
  throw std::logic_error("the fcl simulator has no dynamics: it tells what collides, not what moves");
}

void MeshWorld::contacts(const State&, std::vector<Contact>&) {
  throw std::logic_error("the fcl simulator has no contacts: it tells how deep parts penetrate");
}

void MeshWorld::place(const State& state) {
  if (state.bodies.size() != moving_.size()) throw std::invalid_argument("a state needs one entry per moving part");
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    moving_[i].pose = state.bodies[i].pose * moving_[i].placed->rest;
    moving_[i].box = moved_box(moving_[i].placed->body->box, moving_[i].pose);
  }
}

double MeshWorld::penetration(const State& state) {
  if (!is_finite(state)) return std::numeric_limits<double>::infinity();
  place(state);
  double deepest = 0;
  const std::size_t others = fixed_.size() + moving_.size();
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const Member& m = moving_[i];
    const auto against = [&](const Member& other, std::size_t column) {
      if (deepest >= depth_limit_ || !m.box.overlaps(other.box)) return;  // beyond the limit one pair suffices
      deepest = std::max(deepest, check_.depth(*m.placed->body, m.pose, *other.placed->body, other.pose,
                                               allowed_[i * others + column]));
    };
    for (std::size_t s = 0; s < fixed_.size(); ++s) against(fixed_[s], s);
    for (std::size_t n = i + 1; n < moving_.size(); ++n) against(moving_[n], fixed_.size() + n);
  }
  return deepest;
}

bool MeshWorld::separated(const State& state) {
  if (!is_finite(state)) return false;
  if (rest_hull_.empty()) return true;
  place(state);
  Aabb box;
  for (const auto& m : moving_) box.extend(m.box);
  // Far apart, the boxes already prove it.
  const Eigen::Vector3d gap = (box.lo - rest_box_.hi).cwiseMax(rest_box_.lo - box.hi);
  if (gap.maxCoeff() > separation_gap_) return true;
  moving_hull_.clear();
  for (const auto& m : moving_)
    for (const auto& corner : m.placed->body->hull) moving_hull_.push_back(m.pose * corner);
  return separate(moving_hull_, rest_hull_, separation_gap_).has_value();
}

bool MeshWorld::body_separated(const State& state, std::size_t body) {
  if (!is_finite(state)) return false;
  place(state);
  std::vector<Eigen::Vector3d> others = rest_hull_;
  moving_hull_.clear();
  for (std::size_t i = 0; i < moving_.size(); ++i)
    for (const auto& corner : moving_[i].placed->body->hull)
      (i == body ? moving_hull_ : others).push_back(moving_[i].pose * corner);
  return others.empty() || separate(moving_hull_, others, separation_gap_).has_value();
}

}  // namespace dismantle::mesh_collision
