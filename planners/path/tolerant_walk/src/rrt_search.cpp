#include "dismantle/tolerant_walk/rrt_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/search/growing_turns.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::tolerant_walk {
namespace {

using Vec3 = Eigen::Vector3d;

/// Unit vectors to the 26 neighbours of a cell of a cubic grid.
const std::array<Vec3, 26>& directions() {
  static const std::array<Vec3, 26> all = [] {
    std::array<Vec3, 26> list;
    std::size_t n = 0;
    for (int k = 0; k < 27; ++k)
      if (k != 13) list[n++] = Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized();
    return list;
  }();
  return all;
}

}  // namespace

RrtSearch::RrtSearch(const Parameters& parameters, const PathQuery& query, RunContext& context, GeometryCache& cache,
                     std::uint64_t max_state_checks)
    : parameters_(parameters),
      query_(query),
      rng_(context.rng.fork(0x5c9ee2e)),
      tree_(parameters_, query, context, rng_, cache),
      max_state_checks_(query.budget.max_steps > 0 ? std::min(max_state_checks, query.budget.max_steps)
                                                   : max_state_checks) {
  const auto* state = dynamic_cast<const PoseTree::SearchTreeState*>(query.resume_from);
  if (state == nullptr || !state->obstacles_removed(query.scene, parameters.resume_share)) return;
  tree_.resume(*state);
  resumed_ = true;
  max_state_checks_ -= std::min(tree_.spared(), max_state_checks_ / 2);
  recompute_furthest();
}

void RrtSearch::recompute_furthest() {
  furthest_.fill(0);
  for (std::uint32_t n = 1; n < tree_.size(); ++n)
    if (!tree_[n].cut) update_furthest(n);
}

void RrtSearch::update_furthest(std::uint32_t node) {
  for (std::size_t d = 0; d < furthest_.size(); ++d)
    if (directions()[d].dot(tree_[node].center) > directions()[d].dot(tree_[furthest_[d]].center)) furthest_[d] = node;
}

/// The node to extend, and the first step from it.
std::uint32_t RrtSearch::select_node(PoseTree::Step& step) {
  const auto in_cube = [&] { return Vec3(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
  const double kind = rng_.uniform();
  const std::uint64_t count = tree_.size();
  Vec3 outward = Vec3::Zero();
  std::uint64_t from = 0;
  if (kind < parameters_.outward) {
    const auto d = static_cast<std::size_t>(rng_.below(furthest_.size()));
    from = furthest_[d];
    if (rng_.uniform() < parameters_.outward_step) outward = 1.5 * rng_.uniform() * directions()[d];
  } else if (kind < parameters_.outward + parameters_.recent * (1 - parameters_.outward)) {
    from = count - 1 - rng_.below(std::min(count, static_cast<std::uint64_t>(parameters_.newest)));
  } else {
    from = rng_.below(count);
  }
  // Narrow places need small steps.
  const double octaves = std::log2(parameters_.first_step_max / parameters_.first_step_min);
  const double size = parameters_.step * parameters_.first_step_max * std::exp2(-octaves * rng_.uniform());
  const bool direct = !outward.isZero() && rng_.uniform() < parameters_.direct;
  step.translation = size * (direct ? outward : Vec3(outward + rng_.uniform() * in_cube()));
  step.rotation = direct ? Vec3(Vec3::Zero()) : Vec3(size / tree_.radius() * in_cube());
  return static_cast<std::uint32_t>(from);
}

/// Repeats one step from a node. Steps grow while poses are valid.
bool RrtSearch::extend() {
  PoseTree::Step step;
  std::uint32_t at = select_node(step);
  if (tree_[at].cut) return false;
  const double length = std::max(step.translation.norm(), tree_.radius() * step.rotation.norm());
  const double max_scale = parameters_.longest_step * parameters_.step / std::max(length, 1e-12);
  double scale = 1;
  for (std::int64_t k = 0; k < parameters_.extension_steps && !tree_.halted(); ++k) {
    const Pose next = tree_.extended(at, step, scale);
    if (!tree_.state_valid(next)) {
      if (k == 0 || scale <= 1) break;
      scale = 1;  // a shorter step may still be valid
      continue;
    }
    at = tree_.add(next, at);
    update_furthest(at);
    if (is_goal(at)) return find_verified_path(at);
    scale = std::min(max_scale, parameters_.step_growth * scale);
  }
  return false;
}

/// Compares the hulls only when the node is at least half a longest step further from the start than at the last check.
bool RrtSearch::is_goal(std::uint32_t node) {
  const double far = (tree_[node].center - tree_.center()).norm();
  if (far < goal_checked_at_ + 0.5 * parameters_.longest_step * parameters_.step) return false;
  goal_checked_at_ = far;
  return tree_.separated(tree_[node].pose);
}

bool RrtSearch::find_verified_path(std::uint32_t node) {
  goal_checked_at_ = 0;
  if (tree_.find_verified_path(node, result_)) return true;
  recompute_furthest();
  return false;
}

SearchStatus RrtSearch::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  if (!std::exchange(begun_, true) && tree_.separated(Pose{})) {
    result_.start_is_goal();
    return SearchStatus::solved;
  }
  const Deadline end = path::deadline_of(portion);
  const std::uint64_t until = path::end_of_portion(state_checks(), portion.max_steps, max_state_checks_);
  bool solved = false;
  if (std::exchange(resumed_, false))  // parts have left, so the furthest nodes may be separated now
    for (const std::uint32_t n : std::array(furthest_))
      if (!solved && !tree_.halted() && !tree_[n].cut && tree_.separated(tree_[n].pose)) solved = find_verified_path(n);
  const auto over = [&] { return state_checks() >= max_state_checks_ || tree_.halted() || tree_.given_up(); };
  while (!solved && state_checks() < until && !over() && !end.passed()) solved = extend();
  if (!solved) tree_.set_failure(result_);
  if (!solved && !over()) return SearchStatus::paused;
  return status_of(result_.outcome());
}

PathResult RrtSearch::result() {
  PathResult result = result_;
  if (result.outcome() == Outcome::start_is_goal) return result;
  std::uint32_t best = 0;
  for (const std::uint32_t n : furthest_)
    if ((tree_[n].center - tree_.center()).norm() > (tree_[best].center - tree_.center()).norm()) best = n;
  tree_.fill(best, result);
  return result;
}

}  // namespace dismantle::tolerant_walk
