#include "random_tree.h"

#include <algorithm>

#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::bk_rrt {
namespace {

std::vector<Pose> poses_of(const State& state) {
  std::vector<Pose> poses;
  for (const auto& b : state.bodies) poses.push_back(b.pose);
  return poses;
}

bool same(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return x.t == y.t && x.q.coeffs() == y.q.coeffs(); });
}

}  // namespace

RandomTree::RandomTree(const PathQuery& query, MotionSpace motion, const Parameters& parameters, const Rng& rng)
    : query_(query),
      parameters_(parameters),
      rng_(rng),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, motion)),
      sees_contacts_(query.simulator.capabilities().contacts) {
  const sampling::Surroundings around(query, *world_);
  // Several parts that move at once are told apart by the first of them: where it is draws the tree.
  const sampling::Mover first{query.scene.moving[0].pose * world_->center(0), world_->radius(0)};
  space_ = std::make_unique<sampling::DisplacementSpace>(first, motion, around.bounds);
  for (std::size_t i = 0; i < query.scene.moving.size(); ++i)
    bodies_.push_back({world_->center(i), motion == MotionSpace::translation ? 0.0 : world_->radius(i)});
  add(world_->initial_state(), 0, {});
}

bool RandomTree::starts_out() { return world_->separated(nodes_[0].state); }

std::vector<Pose> RandomTree::farthest() const { return poses_of(nodes_[farthest_].state); }

RandomTree::StateType RandomTree::place(const State& state) const {
  StateType s;
  s.center = state.bodies[0].pose * world_->center(0);
  s.turn = (state.bodies[0].pose.q * query_.scene.moving[0].pose.q.conjugate()).normalized();
  return s;
}

std::uint32_t RandomTree::add(State state, std::uint32_t parent, Path way) {
  const StateType where = place(state);
  const unsigned depth = nodes_.empty() ? 0 : nodes_[parent].depth + 1;
  nodes_.push_back({std::move(state), where, parent, depth, std::move(way)});
  const std::uint32_t id = near_.add(where.center);
  const double moved = (where.center - nodes_[0].place.center).norm();
  if (moved > farthest_way_) {
    farthest_way_ = moved;
    farthest_ = id;
  }
  return id;
}

Action RandomTree::random_action() {
  const bool rigid = world_->space() == MotionSpace::rigid;
  Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Zero();
  if (parameters_.actions == Actions::axes) {
    const std::uint64_t n = rng_.below(rigid ? 12 : 6);
    unit[static_cast<Eigen::Index>(n / 2)] = n % 2 == 0 ? 1 : -1;
  } else {
    for (Eigen::Index k = 0; k < (rigid ? 6 : 3); ++k) unit[k] = rng_.normal();
    unit.normalize();
  }
  Action action;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    action.wrenches.push_back(
        {parameters_.force * unit.head<3>(), parameters_.force * world_->torque_arm(i) * unit.tail<3>()});
  return action;
}

void RandomTree::note_contacts(const State& state) {
  if (!sees_contacts_) return;
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  std::vector<PartId> parts;
  for (const auto& c : contacts)
    if (c.depth > -1e-3) parts.push_back(c.other);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  for (const PartId p : parts) ++touched_[p];
}

Path RandomTree::path_to(std::uint32_t node, std::vector<std::uint32_t>& node_of_instant) const {
  std::vector<std::uint32_t> chain;
  for (std::uint32_t n = node; n != 0; n = nodes_[n].parent) chain.push_back(n);
  std::reverse(chain.begin(), chain.end());
  Path path{poses_of(nodes_[0].state)};
  node_of_instant = {0};
  for (const auto n : chain) {
    path.insert(path.end(), nodes_[n].way.begin(), nodes_[n].way.end());
    node_of_instant.insert(node_of_instant.end(), nodes_[n].way.size(), n);
  }
  return path;
}

bool RandomTree::verified(std::uint32_t node, PathResult& result) {
  std::vector<std::uint32_t> node_of;
  const Path full = path_to(node, node_of);
  const Path path = path::thin(full, bodies_, parameters_.thinning);
  PathCheck check = query_.checker.check(path);
  if (check.accepted()) {
    result.solve(std::move(*check.verified), nodes_[node].depth);
    return true;
  }
  ++refused_;
  result.message = check.reason;
  if (!check.has_witness) {
    discard(node);
    return false;
  }
  world_->add_contact_sample(check.part, check.other, check.point);
  // Thinning keeps instants as they are: find the one after the fault among all, and the action that led there.
  const auto& after = path[std::min(check.instant + 1, path.size() - 1)];
  std::size_t k = 1;
  while (k + 1 < full.size() && !same(full[k], after)) ++k;
  discard(node_of[k]);
  return false;
}

void RandomTree::discard(std::uint32_t node) {
  near_.remove(node);
  for (std::uint32_t n = node + 1; n < nodes_.size(); ++n)  // children come after their parents
    if (nodes_[n].parent >= node && near_.removed(nodes_[n].parent)) near_.remove(n);
}

bool RandomTree::iterate(PathResult& result) {
  StateType drawn;
  space_->draw(rng_, drawn);
  const std::uint32_t from =
      near_.nearest(drawn.center, [&](std::uint32_t n) { return space_->distance(nodes_[n].place, drawn); });
  const Action action = random_action();
  State state = nodes_[from].state;
  Path way;
  const StepReport report = world_->advance(state, action, parameters_.time_step, &way);
  steps_ += std::max<std::uint64_t>(report.steps, 1);
  if (report.stalled) note_contacts(state);
  if (!report.finite || way.empty()) return false;
  way = path::thin(way, bodies_, parameters_.thinning);
  const std::uint32_t node = add(std::move(state), from, std::move(way));
  return world_->separated(nodes_[node].state) && verified(node, result);
}

}  // namespace dismantle::bk_rrt
