#include "dismantle/tolerant_walk/pose_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/path/candidates.h"
#include "dismantle/path/shortcuts.h"
#include "dismantle/path/touched.h"

namespace dismantle::tolerant_walk {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kLookEvery = 0.02;  // assembly units, along a shortcut
constexpr double kTurn = 0.2;        // rad between the instants of a path
constexpr double kInstants = 0.25;   // assembly units, likewise
constexpr double kRoom = 0.1;        // share of the looks in vain at which a tree was
                                     // stuck; less is not what held it
constexpr std::size_t kRepairs = 4;  // tries to shorten the same way, after it has been learned where it cuts

bool stands(const Scene& scene, PartId part) {
  return std::any_of(scene.fixed.begin(), scene.fixed.end(), [part](const PlacedPart& s) { return s.part == part; });
}

}  // namespace

PoseTree::PoseTree(const Parameters& parameters, const PathQuery& query, RunContext& context, Rng& rng, Overlap overlap,
                   GeometryCache& cache)
    : parameters_(parameters),
      query_(query),
      context_(context),
      rng_(rng),
      deadline_(query.budget.timeout > 0 ? context.deadline.earlier(Deadline::after_seconds(query.budget.timeout))
                                         : context.deadline),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, MotionSpace::rigid)),
      tolerance_(query.assembly, query.scene, parameters.tolerance_share * query.tolerance, overlap, cache) {
  const std::size_t count = query.scene.moving.size();
  for (std::size_t i = 0; i < count; ++i) {
    bodies_.push_back({world_->center(i), world_->radius(i)});
    center_ += query.scene.moving[i].pose * bodies_[i].center / static_cast<double>(count);
  }
  for (std::size_t i = 0; i < count; ++i)
    radius_ = std::max(radius_, (query.scene.moving[i].pose * bodies_[i].center - center_).norm() + bodies_[i].radius);
  nodes_.push_back({Pose{}, center_});
}

bool PoseTree::Reached::has_room_now(const Scene& scene) const {
  std::uint64_t all = 0, gone = 0;
  for (const auto& [part, count] : stuck_at) {
    all += count;
    if (!stands(scene, part)) gone += count;
  }
  return gone > 0 && static_cast<double>(gone) >= kRoom * static_cast<double>(all);
}

void PoseTree::resume(const Reached& known) {
  const auto moves = [&](PartId part) {
    return std::any_of(query_.scene.moving.begin(), query_.scene.moving.end(),
                       [part](const PlacedPart& m) { return m.part == part; });
  };
  const auto here = [&](PartId part) { return moves(part) || stands(query_.scene, part); };
  for (const Reached::Lesson& lesson : known.lessons) {
    if (!here(lesson.part) || !here(lesson.other)) continue;
    tolerance_.learn(lesson.part, lesson.other, lesson.point, lesson.displacement);
    lessons_.push_back(lesson);
  }
  nodes_ = known.nodes;
  for (Node& node : nodes_) {  // parents come first
    const Node& parent = nodes_[node.parent];
    if (node.cut && node.cut_by && !stands(query_.scene, *node.cut_by)) node.cut = false, node.cut_by.reset();
    if (parent.cut && !node.cut) node.cut = true, node.cut_by = parent.cut_by;
  }
  for (const auto& [part, count] : known.touched)
    if (stands(query_.scene, part)) touched_[part] = count;
  spared_ = known.looks;
  resumed_ = nodes_.size();
}

std::shared_ptr<const PoseTree::Reached> PoseTree::reached() const {
  auto reached = std::make_shared<Reached>();
  reached->nodes = nodes_;
  reached->lessons = lessons_;
  reached->touched = touched_;
  reached->stuck_at = stuck_at_;
  reached->looks = spared_ + looks_;
  return reached;
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

bool PoseTree::allowed(const Pose& displacement) {
  ++looks_;
  if (tolerance_.allows(displacement)) return true;
  ++touched_[*tolerance_.in_way()];
  ++stuck_at_[*tolerance_.in_way()];
  return false;
}

/// Bound of the way of each point of the moving parts.
double PoseTree::distance(const Pose& a, const Pose& b) const {
  return (a * center_ - b * center_).norm() + radius_ * angle_between(a.q, b.q);
}

Pose PoseTree::after(std::uint32_t node, const Step& step, double scale) const {
  const Eigen::Vector3d turn = scale * step.turn;
  const Eigen::Quaterniond q = turn.isZero() ? Eigen::Quaterniond::Identity()
                                             : Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  Pose next;
  next.q = (q * nodes_[node].pose.q).normalized();
  next.t = nodes_[node].center + scale * step.way - next.q * center_;
  return next;
}

std::uint32_t PoseTree::add(const Pose& pose, std::uint32_t parent) {
  nodes_.push_back({pose, pose * center_, parent});
  return size() - 1;
}

bool PoseTree::separated(const Pose& displacement) const { return world_->separated(state(displacement)); }

std::vector<std::uint32_t> PoseTree::chain_to(std::uint32_t node) const {
  std::vector<std::uint32_t> chain{node};
  while (chain.back() != 0) chain.push_back(nodes_[chain.back()].parent);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

/// Coarse looks first: most motions that are not allowed show it in the middle.
bool PoseTree::straight(const Pose& a, const Pose& b) {
  int pieces = 2;
  while (pieces * kLookEvery < distance(a, b)) pieces *= 2;
  for (int apart = pieces / 2; apart > 0; apart /= 2)
    for (int i = apart; i < pieces; i += 2 * apart)
      if (halted() || !allowed(screw_interpolate(a, b, static_cast<double>(i) / pieces))) return false;
  return true;
}

/// Piece by piece, the longest first; then between any two.
std::vector<Pose> PoseTree::shortened(std::vector<Pose> way) {
  const auto stop = [this] { return halted(); };
  path::shortcut_pieces(
      way, [this](const Pose& a, const Pose& b) { return straight(a, b); }, stop);
  path::shortcut_at_random(
      way, parameters_.shortcuts, rng_,
      [&](std::size_t a, std::size_t b, std::vector<Pose>&) { return straight(way[a], way[b]); }, stop);
  return way;
}

Path PoseTree::path_of(const std::vector<Pose>& way) const {
  Path path{poses(way.front())};
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double pieces_of_turn = angle_between(way[k - 1].q, way[k].q) / kTurn,
                 pieces_of_way = distance(way[k - 1], way[k]) / kInstants;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::max(pieces_of_turn, pieces_of_way))));
    for (int i = 1; i <= pieces; ++i)
      path.push_back(poses(screw_interpolate(way[k - 1], way[k], static_cast<double>(i) / pieces)));
  }
  return path::thin(path, bodies_, parameters_.thinning);
}

bool PoseTree::verified(std::uint32_t node, PathResult& result) {
  const std::vector<std::uint32_t> chain = chain_to(node);
  std::vector<Pose> way, shorter;
  for (const std::uint32_t n : chain) way.push_back(nodes_[n].pose);
  Pose at_fault = way.back();
  std::optional<PartId> by;
  bool tightened = false;
  const auto form = [&](std::size_t round) -> std::optional<Path> {
    if (round > kRepairs || halted() || given_up()) return std::nullopt;
    shorter = shortened(way);
    return path_of(shorter);
  };
  const auto learn = [&](const PathCheck& check, const Path& path) {
    result.message = check.reason;
    if (!check.has_witness) return false;
    const auto& instant = check.poses.empty() ? path[std::min(check.instant, path.size() - 1)] : check.poses;
    by = stands(query_.scene, check.other) ? check.other : check.part;
    at_fault = instant[0] * query_.scene.moving[0].pose.inverse();
    lessons_.push_back({check.part, check.other, check.point, at_fault});
    tightened = tolerance_.learn(check.part, check.other, check.point, at_fault);
    // What was learned may rule out some of the way itself.
    return !tightened && std::all_of(way.begin() + 1, way.end(), [&](const Pose& p) { return halted() || allowed(p); });
  };
  const auto accept = [&](VerifiedPath path) {
    result.solve(std::move(path), static_cast<unsigned>(shorter.size() - 1));
  };
  if (path::show_forms(query_.checker, refused_, form, learn, accept).accepted) return true;
  if (tightened)
    cut_disallowed();
  else if (!halted())
    cut(chain, at_fault, by);
  return false;
}

void PoseTree::cut_off(std::uint32_t node, std::optional<PartId> by) {
  nodes_[node].cut = true;
  nodes_[node].cut_by = by;
}

/// Gives up the first node of the way that is not allowed any more, or the one nearest to where the verifier saw a
/// fault, and what grew from it.
void PoseTree::cut(const std::vector<std::uint32_t>& chain, const Pose& near, std::optional<PartId> by) {
  std::uint32_t first = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < chain.size(); ++k) {
    if (!allowed(nodes_[chain[k]].pose)) {
      first = chain[k];
      by = tolerance_.in_way();
      break;
    }
    if (const double d = distance(nodes_[chain[k]].pose, near); d < least) least = d, first = chain[k];
  }
  if (first == kNone) return;
  cut_off(first, by);
  for (std::uint32_t n = 1; n < nodes_.size(); ++n)  // children come after their parents
    if (const Node& parent = nodes_[nodes_[n].parent]; parent.cut && !nodes_[n].cut) cut_off(n, parent.cut_by);
}

/// What is allowed has changed for good.
void PoseTree::cut_disallowed() {
  for (std::uint32_t n = 1; n < nodes_.size() && !halted(); ++n) {
    if (nodes_[n].cut) continue;
    if (const Node& parent = nodes_[nodes_[n].parent]; parent.cut)
      cut_off(n, parent.cut_by);
    else if (!allowed(nodes_[n].pose))
      cut_off(n, tolerance_.in_way());
  }
}

void PoseTree::explain(PathResult& result) const {
  result.fail(context_.cancel.cancelled()                                        ? Outcome::cancelled
              : deadline_.passed()                                               ? Outcome::timeout
              : given_up()                                                       ? Outcome::exhausted
              : query_.budget.max_steps > 0 && looks_ >= query_.budget.max_steps ? Outcome::timeout
                                                                                 : Outcome::depth_limit);
}

void PoseTree::finish(std::uint32_t best, PathResult& result) const {
  if (!is_success(result.outcome())) {
    result.best_pose = poses(nodes_[best].pose);
    result.state = reached();
  }
  result.stats = {.state_checks = looks_,
                  .nodes = nodes_.size(),
                  .refused = refused_,
                  .resumed_nodes = resumed_,
                  .spared = spared_,
                  .cost = static_cast<double>(looks_)};
  result.blocked_by = path::most_touched(touched_, query_.scene.moving);
}

}  // namespace dismantle::tolerant_walk
