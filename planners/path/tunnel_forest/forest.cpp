#include "forest.h"

#include <algorithm>
#include <cmath>

#include "dismantle/path/touched.h"
#include "dismantle/search/placed_parts.h"

namespace dismantle::tunnel_forest {
namespace {

void append(Mesh& to, const Mesh& mesh, const Pose& pose) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (const auto& v : mesh.vertices) to.vertices.push_back(pose * v);
  for (const auto& t : mesh.triangles) to.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace

Forest::Forest(const PathQuery& query, MotionSpace motion, const Parameters& parameters, const Rng& rng,
               std::function<bool()> halted)
    : query_(query),
      parameters_(parameters),
      halted_(std::move(halted)),
      rng_(rng),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, motion)),
      rigid_(motion == MotionSpace::rigid),
      sees_contacts_(query.simulator.capabilities().contacts),
      local_planner_(*world_, parameters, parameters.free_penetration * query.tolerance),
      center_(query.scene.moving[0].pose * world_->center(0)),
      arm_(rigid_ ? 0.5 * world_->radius(0) : 0.0),
      start_(path::poses_of(query.scene.moving)),
      map_(0.3 * parameters.node_spacing, arm_) {
  const Aabb moving = path::box_of(query.assembly, query.scene.moving);
  bounds_ = path::box_of(query.assembly, query.scene.fixed);
  bounds_.extend(moving);
  bounds_.inflate(0.6 * moving.size().norm());  // room for the part beside the others in any orientation
  map_.add_tree(node_of(world_->initial_state()));
}

Roadmap::Node Forest::node_of(const State& state) {
  Roadmap::Node node;
  node.state = state;
  node.center = state.bodies[0].pose * world_->center(0);
  node.turn = (state.bodies[0].pose.q * start_[0].q.conjugate()).normalized();
  return node;
}

std::vector<Pose> Forest::poses(const Target& target) const {
  const Pose moved = displacement(target);
  std::vector<Pose> all;
  for (const Pose& p : start_) all.push_back(moved * p);
  return all;
}

void Forest::find_tunnels() {
  Mesh moving, fixed;
  for (const auto& m : query_.scene.moving) append(moving, *query_.assembly.parts[m.part].mesh, m.pose);
  if (moving.vertices.empty()) return;
  Aabb near = moving.box();
  near.inflate(parameters_.tunnel_neighborhood * near.size().maxCoeff());
  for (const auto& s : query_.scene.fixed) {
    if (path::box_of(query_.assembly, {s}).overlaps(near)) append(fixed, *query_.assembly.parts[s.part].mesh, s.pose);
  }
  Rng rng = rng_.fork(1);
  const auto samples = static_cast<std::size_t>(parameters_.surface_samples);
  NarrowPlaces of_moving = find_narrow_places(moving, samples, rng);
  tunnel_poses_.emplace(std::move(of_moving), find_narrow_places(fixed, samples, rng), parameters_.tunnel_width);
}

void Forest::add_tunnel_tree(const std::function<bool()>& stop) {
  if (!tunnel_poses_) find_tunnels();
  // Most poses in a tunnel penetrate too deeply to be retracted, so each call draws a few.
  for (int k = 0; k < 4 && !tunnel_poses_->empty() && !stop(); ++k) {
    ++draws_;
    const TunnelPoses::Match match = tunnel_poses_->draw(rng_);
    State state = map_.node(0).state;
    for (std::size_t i = 0; i < start_.size(); ++i) state.bodies[i].pose = match.displacement * start_[i];
    state_checks_ += 2;
    const double clearance = parameters_.free_penetration * query_.tolerance;
    world_->project_to_clearance(state, clearance);
    if (world_->penetration(state) > clearance) continue;
    // A pose retracted out of the tunnel has no advantage over a random one.
    const Pose moved = state.bodies[0].pose * start_[0].inverse();
    if ((moved * match.on_moving - match.on_fixed).norm() > match.reach) continue;
    Roadmap::Node node = node_of(state);
    node.separated = world_->separated(state);
    map_.add_tree(std::move(node));
    ++tunnels_;
    return;
  }
}

Eigen::Vector3d Forest::random_vector() {
  const double x = rng_.normal(), y = rng_.normal(), z = rng_.normal();
  return {x, y, z};
}

Forest::Target Forest::around(const Target& target, double size) {
  Target t = target;
  t.center += size * random_vector();
  if (rigid_) t.turn = (rotation_from_vector(size / arm_ * random_vector()) * t.turn).normalized();
  return t;
}

Forest::Target Forest::anywhere() {
  Target t{Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()};
  for (int k = 0; k < 3; ++k) t.center[k] = rng_.uniform(bounds_.lo[k], bounds_.hi[k]);
  if (rigid_) t.turn = random_turn(rng_);
  return t;
}

Forest::Index Forest::choose_tree() {
  const auto& trees = map_.trees();
  const Index home = map_.node(0).tree;
  if (trees.size() == 1 || rng_.uniform() < parameters_.start_bias) return home;
  return trees[static_cast<std::size_t>(rng_.below(trees.size()))];
}

Forest::Index Forest::choose_node(Index tree) {
  const auto& nodes = map_.tree(tree).nodes;
  Index best = geometry::kNoIndex;
  std::uint64_t least = 0;
  for (std::int64_t k = 0; k < parameters_.tournament; ++k) {
    const Index n = nodes[static_cast<std::size_t>(rng_.below(nodes.size()))];
    const std::uint64_t used = std::uint64_t{map_.node(n).expansions + 1} * map_.density(n);
    if (best == geometry::kNoIndex || used < least) best = n, least = used;
  }
  return best;
}

void Forest::record_contacts(const State& state) {
  if (!sees_contacts_) return;
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  for (const PartId p : path::touched_parts(contacts, query_.scene.moving, query_.tolerance)) ++touched_[p];
}

Forest::Index Forest::add_trajectory(Index from, const LocalPlanner::Trajectory& trajectory) {
  if (trajectory.blocked) record_contacts(trajectory.end);
  if (trajectory.path.empty() ||
      local_planner_.distance(path::poses_of(map_.node(from).state), path::poses_of(trajectory.end)) <
          0.02 * parameters_.node_spacing)
    return geometry::kNoIndex;
  Index last = from;
  Path path;
  double length = 0;
  const std::vector<Pose>* before = nullptr;
  const std::vector<Pose> begin = path::poses_of(map_.node(from).state);
  for (std::size_t k = 0; k < trajectory.path.size(); ++k) {
    length += local_planner_.distance(before != nullptr ? *before : begin, trajectory.path[k]);
    before = &trajectory.path[k];
    path.push_back(trajectory.path[k]);
    const bool end = k + 1 == trajectory.path.size();
    if (length < parameters_.node_spacing && !end) continue;
    State state = trajectory.end;
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      state.bodies[i].pose = trajectory.path[k][i];
      state.bodies[i].velocity.setZero();
      state.bodies[i].angular_velocity.setZero();
    }
    Path whole{path::poses_of(map_.node(last).state)};
    whole.insert(whole.end(), path.begin(), path.end());
    whole = path::thin(whole, local_planner_.bodies(), parameters_.thinning);
    whole.erase(whole.begin());
    Roadmap::Node node = node_of(state);
    node.separated = end && world_->separated(state);
    last = map_.grow(last, std::move(node), std::move(whole));
    const double moved = (map_.node(last).center - map_.node(0).center).norm();
    if (map_.node(last).tree == map_.node(0).tree && moved > farthest_distance_)
      farthest_distance_ = moved, farthest_ = last;
    path.clear();
    length = 0;
  }
  return last;
}

bool Forest::join(Index n, Index to, const std::function<bool()>& stop) {
  const double range = 2 * parameters_.join_distance;
  const LocalPlanner::Trajectory trajectory =
      local_planner_.steer(map_.node(n).state, path::poses_of(map_.node(to).state), range, stop);
  const Index end = add_trajectory(n, trajectory);
  if (!trajectory.arrived) return false;
  const Index from = end == geometry::kNoIndex ? n : end;
  map_.join(from, to, {path::poses_of(map_.node(to).state)});
  return true;
}

void Forest::try_joins(Index n, const std::function<bool()>& stop) {
  const std::vector<Index> trees = map_.trees();  // a copy, because joins change the list
  for (const Index t : trees) {
    const Index own = map_.node(n).tree, home = map_.node(0).tree;
    if (t == own || map_.tree(t).nodes.empty()) continue;
    const double chance = own == home || t == home ? parameters_.join_start : parameters_.join_others;
    if (rng_.uniform() >= chance || stop()) continue;
    const Target here = target_of(n);
    const Index to = map_.nearest(here.center, here.turn, t);
    if (map_.distance(here.center, here.turn, map_.node(to)) <= parameters_.join_distance) join(n, to, stop);
  }
}

bool Forest::iterate(PathResult& result, const std::function<bool()>& stop) {
  const auto wanted = static_cast<std::uint64_t>(parameters_.tunnels);
  if (rigid_ && wanted > 0 &&
      tunnels_ < wanted + iterations_ / static_cast<std::uint64_t>(parameters_.extensions_per_tunnel) &&
      draws_ * static_cast<std::uint64_t>(parameters_.draw_cost) <= local_planner_.steps())
    add_tunnel_tree(stop);
  ++iterations_;
  if (stop()) return false;

  const Index tree = choose_tree();
  const double kind_of_target = rng_.uniform();
  Index from = geometry::kNoIndex;
  Target target = target_of(0);
  double range = parameters_.range * parameters_.node_spacing;
  if (kind_of_target < parameters_.local_share) {
    from = choose_node(tree);
    range = parameters_.node_spacing * parameters_.local_range_min *
            std::pow(parameters_.local_range_max / parameters_.local_range_min, rng_.uniform());
    // Translates, rotates, or both.
    target = target_of(from);
    const auto kind = rigid_ ? rng_.below(3) : 0;
    if (kind != 1) target.center += range * random_vector().normalized();
    if (kind != 0)
      target.turn =
          (rotation_from_vector(std::min(range / arm_, 3.0) * random_vector().normalized()) * target.turn).normalized();
  } else if (kind_of_target < parameters_.local_share + parameters_.uniform_share) {
    target = anywhere();
  } else {
    const auto& trees = map_.trees();
    const auto& others = map_.tree(trees[static_cast<std::size_t>(rng_.below(trees.size()))]).nodes;
    target = around(target_of(others[static_cast<std::size_t>(rng_.below(others.size()))]),
                    parameters_.node_spacing * std::pow(10.0, rng_.uniform(-1, 0.5)));
  }
  if (from == geometry::kNoIndex) from = map_.nearest(target.center, target.turn, tree);
  ++map_.node(from).expansions;
  const LocalPlanner::Trajectory trajectory = local_planner_.steer(map_.node(from).state, poses(target), range, stop);
  const Index end = add_trajectory(from, trajectory);
  if (end == geometry::kNoIndex) return false;
  try_joins(end, stop);
  return map_.tree(map_.node(0).tree).separated > 0 && find_verified_path(result);
}

}  // namespace dismantle::tunnel_forest
