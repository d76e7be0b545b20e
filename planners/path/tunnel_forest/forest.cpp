#include "forest.h"

#include <algorithm>
#include <cmath>

namespace dismantle::tunnel_forest {
namespace {

/// Where nodes are counted (Roadmap::crowd), and the least way that makes a state a new one; assembly units.
constexpr double kCell = 0.3, kNew = 0.02;
/// Share of extensions that begin in the tree at the start, while there are others.
constexpr double kHome = 0.5;
/// Shares of extensions: about a node that few others are near, towards any state, the rest towards another tree.
constexpr double kLocal = 0.4, kAnywhere = 0.35;
/// Of so many nodes drawn, the one is extended that has been least, among the least others.
constexpr int kContest = 6;
/// Extensions towards any state; those about a node draw theirs.
constexpr double kRange = 2, kShortest = 0.05, kLongest = 5;
/// A join may be so much longer than its nodes are apart.
constexpr double kDetour = 2;
/// Of the trees that a node could be joined to, so many (share) are tried; of pairs without the start, fewer.
constexpr double kTryJoin = 0.5, kTryOther = 0.1;
/// A pose in a tunnel keeps so much from contact if it can, and penetrates no deeper: share of the tolerance.
constexpr double kClearanceShare = 0.2;
/// A pose that is drawn costs about as much as so many simulated steps; tunnels get no more of the work than growth.
constexpr std::uint64_t kStepsPerDraw = 60;
/// One more tunnel after so many extensions.
constexpr std::uint64_t kExtensionsPerTunnel = 100;
/// Still parts count for tunnels when their boxes come so near to what moves (share of its size).
constexpr double kNearby = 0.25;

std::vector<Pose> start_poses(const PathQuery& query) {
  std::vector<Pose> all;
  for (const auto& m : query.scene.moving) all.push_back(m.pose);
  return all;
}

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
      guide_(*world_, parameters),
      center_(query.scene.moving[0].pose * world_->center(0)),
      arm_(rigid_ ? 0.5 * world_->radius(0) : 0.0),
      start_(start_poses(query)),
      map_(kCell, arm_) {
  Aabb moving;
  for (const auto& m : query.scene.moving)
    for (const auto& v : query.assembly.parts[m.part].mesh->vertices) moving.extend(m.pose * v);
  bounds_ = moving;
  for (const auto& s : query.scene.fixed)
    for (const auto& v : query.assembly.parts[s.part].mesh->vertices) bounds_.extend(s.pose * v);
  bounds_.inflate(0.6 * moving.size().norm());
  map_.plant(node_of(world_->initial_state()));
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

void Forest::look_for_tunnels() {
  Mesh moving, fixed;
  for (const auto& m : query_.scene.moving) append(moving, *query_.assembly.parts[m.part].mesh, m.pose);
  if (moving.vertices.empty()) return;
  Aabb near = moving.box();
  near.inflate(kNearby * near.size().maxCoeff());
  for (const auto& s : query_.scene.fixed) {
    const Mesh& mesh = *query_.assembly.parts[s.part].mesh;
    Aabb box;
    for (const auto& v : mesh.vertices) box.extend(s.pose * v);
    if (box.overlaps(near)) append(fixed, mesh, s.pose);
  }
  Rng rng = rng_.fork(1);
  const auto samples = static_cast<std::size_t>(parameters_.surface_samples);
  NarrowPlaces of_moving = find_narrow_places(moving, samples, rng);
  tunnel_poses_.emplace(std::move(of_moving), find_narrow_places(fixed, samples, rng));
}

void Forest::plant_tunnel(const std::function<bool()>& stop) {
  if (!tunnel_poses_) look_for_tunnels();
  constexpr int kDraws = 4;
  for (int k = 0; k < kDraws && !tunnel_poses_->empty() && !stop(); ++k) {
    ++draws_;
    const TunnelPoses::Match match = tunnel_poses_->draw(rng_);
    State state = map_.node(0).state;
    for (std::size_t i = 0; i < start_.size(); ++i) state.bodies[i].pose = match.displacement * start_[i];
    looks_ += 2;
    const double clearance = kClearanceShare * query_.tolerance;
    world_->project_to_clearance(state, clearance);
    if (world_->penetration(state) > clearance) continue;
    // Pushed out of the tunnel, it is as good as any other state.
    const Pose moved = state.bodies[0].pose * start_[0].inverse();
    if ((moved * match.on_moving - match.on_fixed).norm() > match.reach) continue;
    Roadmap::Node node = node_of(state);
    node.out = world_->separated(state);
    map_.plant(std::move(node));
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
  if (trees.size() == 1 || rng_.uniform() < kHome) return home;
  return trees[static_cast<std::size_t>(rng_.below(trees.size()))];
}

Forest::Index Forest::choose_node(Index tree) {
  const auto& nodes = map_.tree(tree).nodes;
  Index best = Roadmap::kNone;
  std::uint64_t least = 0;
  for (int k = 0; k < kContest; ++k) {
    const Index n = nodes[static_cast<std::size_t>(rng_.below(nodes.size()))];
    const std::uint64_t used = std::uint64_t{map_.node(n).expansions + 1} * map_.crowd(n);
    if (best == Roadmap::kNone || used < least) best = n, least = used;
  }
  return best;
}

void Forest::note_contacts(const State& state) {
  if (!sees_contacts_) return;
  constexpr double kTouching = -1e-3;
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  std::vector<PartId> parts;
  for (const auto& c : contacts)
    if (c.depth > kTouching) parts.push_back(c.other);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  for (const PartId p : parts) ++touched_[p];
}

Forest::Index Forest::keep(Index from, const Guide::Trip& trip) {
  if (trip.blocked) note_contacts(trip.end);
  if (trip.way.empty() || guide_.distance(poses_of(map_.node(from).state), poses_of(trip.end)) < kNew)
    return Roadmap::kNone;
  Index last = from;
  Path way;
  double length = 0;
  const std::vector<Pose>* before = nullptr;
  const std::vector<Pose> begin = poses_of(map_.node(from).state);
  for (std::size_t k = 0; k < trip.way.size(); ++k) {
    length += guide_.distance(before != nullptr ? *before : begin, trip.way[k]);
    before = &trip.way[k];
    way.push_back(trip.way[k]);
    const bool end = k + 1 == trip.way.size();
    if (length < parameters_.node_spacing && !end) continue;
    State state = trip.end;
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      state.bodies[i].pose = trip.way[k][i];
      state.bodies[i].velocity.setZero();
      state.bodies[i].angular_velocity.setZero();
    }
    Path whole{poses_of(map_.node(last).state)};
    whole.insert(whole.end(), way.begin(), way.end());
    whole = path::thin(whole, guide_.bodies(), parameters_.thinning);
    whole.erase(whole.begin());
    Roadmap::Node node = node_of(state);
    node.out = end && world_->separated(state);
    last = map_.grow(last, std::move(node), std::move(whole));
    const double moved = (map_.node(last).center - map_.node(0).center).norm();
    if (map_.node(last).tree == map_.node(0).tree && moved > farthest_way_) farthest_way_ = moved, farthest_ = last;
    way.clear();
    length = 0;
  }
  return last;
}

bool Forest::join(Index n, Index to, const std::function<bool()>& stop) {
  const double range = kDetour * parameters_.join_distance;
  const Guide::Trip trip = guide_.go(map_.node(n).state, poses_of(map_.node(to).state), range, stop);
  const Index end = keep(n, trip);
  if (!trip.arrived) return false;
  const Index from = end == Roadmap::kNone ? n : end;
  map_.join(from, to, {poses_of(map_.node(to).state)});
  return true;
}

void Forest::try_joins(Index n, const std::function<bool()>& stop) {
  const std::vector<Index> trees = map_.trees();  // joins change it
  for (const Index t : trees) {
    const Index own = map_.node(n).tree, home = map_.node(0).tree;
    if (t == own || map_.tree(t).nodes.empty()) continue;
    const double chance = own == home || t == home ? kTryJoin : kTryJoin * kTryOther;
    if (rng_.uniform() >= chance || stop()) continue;
    const Target here = place(n);
    const Index to = map_.nearest(here.center, here.turn, t);
    if (map_.distance(here.center, here.turn, map_.node(to)) <= parameters_.join_distance) join(n, to, stop);
  }
}

bool Forest::iterate(PathResult& result, const std::function<bool()>& stop) {
  const auto wanted = static_cast<std::uint64_t>(parameters_.tunnels);
  if (rigid_ && wanted > 0 && tunnels_ < wanted + iterations_ / kExtensionsPerTunnel &&
      draws_ * kStepsPerDraw <= guide_.steps())
    plant_tunnel(stop);
  ++iterations_;
  if (stop()) return false;

  const Index tree = choose_tree();
  const double what = rng_.uniform();
  Index from = Roadmap::kNone;
  Target target = place(0);
  double range = kRange;
  if (what < kLocal) {
    from = choose_node(tree);
    range = kShortest * std::pow(kLongest / kShortest, rng_.uniform());
    // A slide, a turn, or both.
    target = place(from);
    const auto kind = rigid_ ? rng_.below(3) : 0;
    if (kind != 1) target.center += range * random_vector().normalized();
    if (kind != 0)
      target.turn =
          (rotation_from_vector(std::min(range / arm_, 3.0) * random_vector().normalized()) * target.turn).normalized();
  } else if (what < kLocal + kAnywhere) {
    target = anywhere();
  } else {
    const auto& trees = map_.trees();
    const auto& others = map_.tree(trees[static_cast<std::size_t>(rng_.below(trees.size()))]).nodes;
    target = around(place(others[static_cast<std::size_t>(rng_.below(others.size()))]),
                    std::pow(10.0, rng_.uniform(-1, 0.5)));
  }
  if (from == Roadmap::kNone) from = map_.nearest(target.center, target.turn, tree);
  ++map_.node(from).expansions;
  const Guide::Trip trip = guide_.go(map_.node(from).state, poses(target), range, stop);
  const Index end = keep(from, trip);
  if (end == Roadmap::kNone) return false;
  try_joins(end, stop);
  return map_.tree(map_.node(0).tree).out > 0 && verified(result);
}

}  // namespace dismantle::tunnel_forest
