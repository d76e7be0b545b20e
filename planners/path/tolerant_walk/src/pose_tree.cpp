#include "dismantle/tolerant_walk/pose_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/path/touched.h"
#include "dismantle/search/candidates.h"
#include "dismantle/search/placed_parts.h"
#include "dismantle/search/shortcuts.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::tolerant_walk {

PoseTree::PoseTree(const TreeParameters& parameters, const PathQuery& query, RunContext& context, Rng& rng,
                   GeometryCache& cache)
    : parameters_(parameters),
      query_(query),
      context_(context),
      rng_(rng),
      deadline_(path::deadline_of(query, context)),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, MotionSpace::rigid)),
      validity_(query.assembly, query.scene, parameters.tolerance_share * query.tolerance, cache,
                {{parameters.field_cell * query.tolerance}, static_cast<std::size_t>(parameters.max_samples)}) {
  const std::size_t count = query.scene.moving.size();
  bodies_ = path::balls_of(*world_);
  for (std::size_t i = 0; i < count; ++i)
    center_ += query.scene.moving[i].pose * bodies_[i].center / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i)
    radius_ = std::max(radius_, (query.scene.moving[i].pose * bodies_[i].center - center_).norm() + bodies_[i].radius);
  nodes_.push_back({Pose{}, center_});
}

bool PoseTree::SearchTreeState::obstacles_removed(const Scene& scene, double share) const {
  std::uint64_t all = 0, gone = 0;
  for (const auto& [part, count] : blocked) {
    all += count;
    if (!path::contains(scene.fixed, part)) gone += count;
  }
  return gone > 0 && static_cast<double>(gone) >= share * static_cast<double>(all);
}

void PoseTree::resume(const SearchTreeState& known) {
  const auto here = [&](PartId part) {
    return path::contains(query_.scene.moving, part) || path::contains(query_.scene.fixed, part);
  };
  for (const SearchTreeState::RefusedPlace& place : known.refused_places) {
    if (!here(place.part) || !here(place.other)) continue;
    validity_.add_contact_sample(place.part, place.other, place.point, place.displacement);
    refused_places_.push_back(place);
  }
  nodes_ = known.nodes;
  for (Node& node : nodes_) {  // parents come before their children
    const Node& parent = nodes_[node.parent];
    if (node.cut && node.cut_by && !path::contains(query_.scene.fixed, *node.cut_by))
      node.cut = false, node.cut_by.reset();
    if (parent.cut && !node.cut) node.cut = true, node.cut_by = parent.cut_by;
  }
  for (const auto& [part, count] : known.touched)
    if (path::contains(query_.scene.fixed, part)) touched_[part] = count;
  spared_ = known.state_checks;
  resumed_ = nodes_.size();
}

std::shared_ptr<const PoseTree::SearchTreeState> PoseTree::search_state() const {
  auto state = std::make_shared<SearchTreeState>();
  state->nodes = nodes_;
  state->refused_places = refused_places_;
  state->touched = touched_;
  state->blocked = blocked_;
  state->state_checks = spared_ + state_checks_;
  return state;
}

bool PoseTree::halted() const { return context_.cancel.cancelled() || deadline_.passed(); }

std::vector<Pose> PoseTree::poses(const Pose& displacement) const {
  std::vector<Pose> list;
  for (const auto& m : query_.scene.moving) {
    Pose p = displacement * m.pose;
    p.q.normalize();
    list.push_back(p);
  }
  return list;
}

State PoseTree::state(const Pose& displacement) const {
  State s = world_->initial_state();
  const std::vector<Pose> list = poses(displacement);
  for (std::size_t i = 0; i < list.size(); ++i) s.bodies[i].pose = list[i];
  return s;
}

bool PoseTree::state_valid(const Pose& displacement) {
  ++state_checks_;
  if (validity_.is_valid(displacement)) return true;
  ++touched_[*validity_.obstacle()];
  ++blocked_[*validity_.obstacle()];
  return false;
}

/// Upper bound of how far any point of the moving parts moves.
double PoseTree::distance(const Pose& a, const Pose& b) const {
  return (a * center_ - b * center_).norm() + radius_ * angle_between(a.q, b.q);
}

Pose PoseTree::extended(std::uint32_t node, const Step& step, double scale) const {
  const Eigen::Vector3d rotation = scale * step.rotation;
  const Eigen::Quaterniond q = rotation.isZero()
                                   ? Eigen::Quaterniond::Identity()
                                   : Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  Pose next;
  next.q = (q * nodes_[node].pose.q).normalized();
  next.t = nodes_[node].center + scale * step.translation - next.q * center_;
  return next;
}

std::uint32_t PoseTree::add(const Pose& pose, std::uint32_t parent) {
  nodes_.push_back({pose, pose * center_, parent});
  return size() - 1;
}

bool PoseTree::separated(const Pose& displacement) const { return world_->separated(state(displacement)); }

std::vector<std::uint32_t> PoseTree::branch_to(std::uint32_t node) const {
  std::vector<std::uint32_t> branch{node};
  while (branch.back() != 0) branch.push_back(nodes_[branch.back()].parent);
  std::reverse(branch.begin(), branch.end());
  return branch;
}

/// Checks the middle first, then the quarters, and so on, because most invalid motions are invalid in the middle.
bool PoseTree::motion_valid(const Pose& a, const Pose& b) {
  int pieces = 2;
  while (pieces * parameters_.check_spacing * query_.tolerance < distance(a, b)) pieces *= 2;
  for (int apart = pieces / 2; apart > 0; apart /= 2)
    for (int i = apart; i < pieces; i += 2 * apart)
      if (halted() || !state_valid(screw_interpolate(a, b, static_cast<double>(i) / pieces))) return false;
  return true;
}

/// Tries direct motions over whole pieces, longest first, then between random waypoints.
std::vector<Pose> PoseTree::shortened(std::vector<Pose> waypoints) {
  const auto stop = [this] { return halted(); };
  path::shortcut_pieces(
      waypoints, [this](const Pose& a, const Pose& b) { return motion_valid(a, b); }, stop);
  path::shortcut_at_random(
      waypoints, parameters_.shortcuts, rng_,
      [&](std::size_t a, std::size_t b, std::vector<Pose>&) { return motion_valid(waypoints[a], waypoints[b]); }, stop);
  return waypoints;
}

Path PoseTree::path_of(const std::vector<Pose>& waypoints) const {
  Path path{poses(waypoints.front())};
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    const double angle = angle_between(waypoints[k - 1].q, waypoints[k].q);
    const int pieces = std::max(1, static_cast<int>(std::ceil(angle / path::kMostTurn)));
    for (int i = 1; i <= pieces; ++i)
      path.push_back(poses(screw_interpolate(waypoints[k - 1], waypoints[k], static_cast<double>(i) / pieces)));
  }
  return path::thin(path, bodies_, parameters_.thinning);
}

bool PoseTree::find_verified_path(std::uint32_t node, PathResult& result) {
  const std::vector<std::uint32_t> branch = branch_to(node);
  std::vector<Pose> waypoints, shortened_waypoints;
  for (const std::uint32_t n : branch) waypoints.push_back(nodes_[n].pose);
  Pose at_fault = waypoints.back();
  std::optional<PartId> by;
  const auto form = [&](std::size_t round) -> std::optional<Path> {
    if (round > static_cast<std::size_t>(parameters_.repairs) || halted() || given_up()) return std::nullopt;
    shortened_waypoints = shortened(waypoints);
    return path_of(shortened_waypoints);
  };
  const auto learn = [&](const PathCheck& check, const Path& path) {
    result.message = check.reason;
    if (!check.has_witness) return false;
    const auto& instant = check.poses.empty() ? path[std::min(check.instant, path.size() - 1)] : check.poses;
    by = path::contains(query_.scene.fixed, check.other) ? check.other : check.part;
    at_fault = instant[0] * query_.scene.moving[0].pose.inverse();
    refused_places_.push_back({check.part, check.other, check.point, at_fault});
    validity_.add_contact_sample(check.part, check.other, check.point, at_fault);
    // The new samples may invalidate waypoints of the branch itself.
    return std::all_of(waypoints.begin() + 1, waypoints.end(),
                       [&](const Pose& p) { return halted() || state_valid(p); });
  };
  const auto accept = [&](VerifiedPath path) {
    result.solve(std::move(path), static_cast<unsigned>(shortened_waypoints.size() - 1));
  };
  if (path::show_forms(query_.checker, refused_, form, learn, accept).accepted) return true;
  if (!halted()) cut(branch, at_fault, by);
  return false;
}

void PoseTree::cut_off(std::uint32_t node, std::optional<PartId> by) {
  nodes_[node].cut = true;
  nodes_[node].cut_by = by;
}

/// Cuts the subtree of the branch's first node that is no longer valid. If all are valid, cuts at the node nearest to
/// the refused pose.
void PoseTree::cut(const std::vector<std::uint32_t>& branch, const Pose& near, std::optional<PartId> by) {
  std::optional<std::uint32_t> first;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < branch.size(); ++k) {
    if (!state_valid(nodes_[branch[k]].pose)) {
      first = branch[k];
      by = validity_.obstacle();
      break;
    }
    if (const double d = distance(nodes_[branch[k]].pose, near); d < least) least = d, first = branch[k];
  }
  if (!first) return;
  cut_off(*first, by);
  for (std::uint32_t n = 1; n < nodes_.size(); ++n)  // children come after their parents
    if (const Node& parent = nodes_[nodes_[n].parent]; parent.cut && !nodes_[n].cut) cut_off(n, parent.cut_by);
}

void PoseTree::set_failure(PathResult& result) const {
  result.fail(context_.cancel.cancelled()                                               ? Outcome::cancelled
              : deadline_.passed()                                                      ? Outcome::timeout
              : given_up()                                                              ? Outcome::exhausted
              : query_.budget.max_steps > 0 && state_checks_ >= query_.budget.max_steps ? Outcome::timeout
                                                                                        : Outcome::depth_limit);
}

void PoseTree::fill(std::uint32_t best, PathResult& result) const {
  if (!is_success(result.outcome())) {
    result.best_pose = poses(nodes_[best].pose);
    result.state = search_state();
  }
  result.stats = {.state_checks = state_checks_,
                  .nodes = nodes_.size(),
                  .refused = refused_,
                  .resumed_nodes = resumed_,
                  .spared = spared_,
                  .cost = static_cast<double>(state_checks_)};
  result.blocked_by = path::most_touched(touched_, query_.scene.moving);
}

}  // namespace dismantle::tolerant_walk
