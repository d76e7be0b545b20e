#include "random_tree.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/path/touched.h"
#include "dismantle/search/candidates.h"
#include "dismantle/search/placed_parts.h"

namespace dismantle::bk_rrt {
namespace {

bool same(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return x.t == y.t && x.q.coeffs() == y.q.coeffs(); });
}

}  // namespace

RandomTree::RandomTree(const PathQuery& query, MotionSpace motion, const Parameters& parameters,
                       const RunContext& context, const Rng& rng)
    : query_(query),
      record_(query, context),
      parameters_(parameters),
      rng_(rng),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, motion)),
      sees_contacts_(query.simulator.capabilities().contacts) {
  const sampling::Surroundings around(query, *world_);
  // The displacement of the first moving part represents all parts in distances between nodes.
  const sampling::Mover first{query.scene.moving[0].pose * world_->center(0), world_->radius(0)};
  space_ = std::make_unique<sampling::DisplacementSpace>(first, motion, around.bounds);
  bodies_ = path::balls_of(*world_);
  add(world_->initial_state(), 0, {});
}

bool RandomTree::starts_separated() { return world_->separated(nodes_[0].state); }

std::vector<Pose> RandomTree::farthest() const { return path::poses_of(nodes_[farthest_].state); }

RandomTree::StateType RandomTree::displacement_of(const State& state) const {
  StateType s;
  s.center = state.bodies[0].pose * world_->center(0);
  s.turn = (state.bodies[0].pose.q * query_.scene.moving[0].pose.q.conjugate()).normalized();
  return s;
}

std::uint32_t RandomTree::add(State state, std::uint32_t parent, Path path) {
  const StateType where = displacement_of(state);
  const unsigned depth = nodes_.empty() ? 0 : nodes_[parent].depth + 1;
  nodes_.push_back({std::move(state), where, parent, depth, std::move(path)});
  const std::uint32_t id = near_.add(where.center);
  const double moved = (where.center - nodes_[0].displacement.center).norm();
  if (record_.listens())
    record_.node(id == 0 ? -1 : static_cast<std::ptrdiff_t>(parent), path::poses_of(nodes_[id].state),
                 static_cast<double>(steps_), moved);
  if (moved > farthest_distance_) {
    farthest_distance_ = moved;
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

void RandomTree::record_contacts(const State& state) {
  if (!sees_contacts_) return;
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  for (const PartId p : path::touched_parts(contacts, query_.scene.moving, query_.tolerance)) ++touched_[p];
}

Path RandomTree::path_to(std::uint32_t node, std::vector<std::uint32_t>& node_of_instant) const {
  std::vector<std::uint32_t> branch;
  for (std::uint32_t n = node; n != 0; n = nodes_[n].parent) branch.push_back(n);
  std::reverse(branch.begin(), branch.end());
  Path path{path::poses_of(nodes_[0].state)};
  node_of_instant = {0};
  for (const auto n : branch) {
    path.insert(path.end(), nodes_[n].path.begin(), nodes_[n].path.end());
    node_of_instant.insert(node_of_instant.end(), nodes_[n].path.size(), n);
  }
  return path;
}

bool RandomTree::find_verified_path(std::uint32_t node, PathResult& result) {
  std::vector<std::uint32_t> node_of;
  const Path full = path_to(node, node_of);
  const Path path = path::thin(full, bodies_, parameters_.thinning);
  const path::Shown shown = path::show_forms(
      query_.checker, refused_, [&](std::size_t k) { return k == 0 ? std::optional(path) : std::nullopt; },
      [&](const PathCheck& check, const Path&) {
        result.message = check.reason;
        if (check.has_witness) world_->add_contact_sample(check.part, check.other, check.point);
        return true;
      },
      [&](VerifiedPath verified) { result.solve(std::move(verified), nodes_[node].depth); });
  if (shown.accepted) return true;
  if (!shown.last.has_witness) {
    discard(node);
    return false;
  }
  // Thinning changes no pose, so the pose after the fault is in the whole path; its node is at fault.
  const auto& after = path[std::min(shown.last.instant + 1, path.size() - 1)];
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
      near_.nearest(drawn.center, [&](std::uint32_t n) { return space_->distance(nodes_[n].displacement, drawn); });
  const Action action = random_action();
  State state = nodes_[from].state;
  Path path;
  const StepReport report = world_->advance(state, action, parameters_.time_step, &path);
  steps_ += std::max<std::uint64_t>(report.steps, 1);
  if (report.stalled) record_contacts(state);
  if (!report.finite || path.empty()) return false;
  path = path::thin(path, bodies_, parameters_.thinning);
  const std::uint32_t node = add(std::move(state), from, std::move(path));
  return world_->separated(nodes_[node].state) && find_verified_path(node, result);
}

}  // namespace dismantle::bk_rrt
