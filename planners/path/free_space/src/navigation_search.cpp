#include "dismantle/free_space/navigation_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/geometry/slippage.h"
#include "dismantle/path/growing_turns.h"
#include "dismantle/path/time_limit.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;
using geometry::Twist;

/// Radius of the ball that stands for the body in the navigation function: the lower quartile, so that one thin end of
/// the body does not determine it.
double ball_radius(const std::vector<MedialBall>& balls) {
  std::vector<double> radii;
  for (const auto& b : balls) radii.push_back(b.radius);
  if (radii.empty()) return 0;
  const auto quartile = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 4);
  std::nth_element(radii.begin(), quartile, radii.end());
  return *quartile;
}

std::vector<MedialBall> control_points_of(const PathQuery& query, std::int64_t count) {
  std::vector<MedialBall> all;
  const std::size_t each = std::max<std::size_t>(4, static_cast<std::size_t>(count) / query.scene.moving.size());
  for (const auto& m : query.scene.moving)
    for (MedialBall ball : medial_balls(*query.assembly.parts[m.part].mesh, each)) {
      ball.center = m.pose * ball.center;
      all.push_back(ball);
    }
  return all;
}

}  // namespace

bool thinner_than_overlap(const PathQuery& query, std::int64_t control_points) {
  double overlap = 0;
  for (const auto& m : query.scene.moving)
    for (const auto& s : query.scene.fixed) overlap = std::max(overlap, query.assembly.initial_overlap(m.part, s.part));
  // Half a radius is a quarter of the thickness, the penetration that the verifier tolerates in a thin wall.
  return overlap > 0 && overlap > 0.5 * ball_radius(control_points_of(query, control_points));
}

NavigationSearch::NavigationSearch(const SearchParameters& parameters, const PathQuery& query, RunContext& context,
                                   const Effort& effort, tolerant_walk::Overlap overlap,
                                   tolerant_walk::GeometryCache& cache)
    : parameters_(parameters),
      query_(query),
      rng_(context.rng.fork(0x1ed0a1c)),
      tree_(parameters_, query, context, rng_, overlap, cache),
      control_points_(control_points_of(query, parameters.control_points)),
      navigation_(query.assembly, query.scene.fixed, ball_radius(control_points_), parameters),
      has_route_out_(route_from_body()),
      thin_(overlap == tolerant_walk::Overlap::near_start),
      effort_(effort) {
  if (query.scene.moving.size() == 1) {
    const PlacedPart& m = query.scene.moving.front();
    for (const Twist& motion :
         geometry::slippable_motions(*query.assembly.parts[m.part].mesh, m.pose.inverse() * tree_.center()))
      slippable_motions_.push_back({m.pose.q * motion.linear, m.pose.q * motion.angular});
  }
  projection_cell_size_ = std::max(2 * longest_step(), parameters_.projection_cell * tree_.radius());
  if (const auto* state = dynamic_cast<const PoseTree::SearchTreeState*>(query.resume_from);
      state != nullptr && state->obstacles_removed(query.scene, parameters.resume_share)) {
    tree_.resume(*state);
    resumed_ = true;
    for (std::uint32_t n = 0; n < tree_.size(); ++n) thin_moved_ = thin_moved_ || (!tree_[n].cut && thin_and_moved(n));
  }
  rebuild_cells();
}

/// At least half of the control points are in cells with a route, or at most two cells beside one: a surface marks the
/// cells on both of its sides.
bool NavigationSearch::route_from_body() const {
  const auto count = std::count_if(control_points_.begin(), control_points_.end(),
                                   [&](const MedialBall& p) { return navigation_.cells_to_route(p.center) <= 2; });
  return count > 0 && 2 * static_cast<std::size_t>(count) >= control_points_.size();
}

/// Groups all nodes of the tree again, with the current navigation function.
void NavigationSearch::rebuild_cells() {
  cell_of_key_.clear();
  cells_.clear();
  for (auto& scores : cells_by_score_) scores.clear();
  least_ = remaining(Pose{});
  best_remaining_ = goal_checked_at_ = least_.back();
  best_ = 0;
  for (std::uint32_t n = 0; n < tree_.size(); ++n) {
    if (tree_[n].cut) continue;
    const Remaining lengths = remaining(tree_[n].pose);
    insert(n, lengths);
    for (std::size_t r = 0; r < kRanks; ++r) least_[r] = std::min(least_[r], lengths[r]);
    if (lengths.back() < best_remaining_) best_remaining_ = lengths.back(), best_ = n;
  }
  progress_at_ = work();
}

/// A ball may pass where the body does not. Blocks the narrowest place ahead of the best node, within one diameter of
/// the body and two cells (for bodies smaller than a cell).
bool NavigationSearch::detour() {
  const double reach = 2 * tree_.radius() + 2 * navigation_.cell();
  if (!navigation_.close_narrowest(tree_[best_].pose * tree_.center(), reach)) return false;
  has_route_out_ = route_from_body();
  if (has_route_out_) rebuild_cells();
  return has_route_out_;
}

NavigationSearch::Remaining NavigationSearch::remaining(const Pose& pose) const {
  std::vector<double> lengths;
  for (const MedialBall& p : control_points_) lengths.push_back(navigation_.remaining(pose * p.center));
  std::sort(lengths.begin(), lengths.end());
  const std::size_t all = lengths.size();
  const std::array<std::size_t, kRanks> counts{std::min<std::size_t>(1, all), (all + 3) / 4, (all + 1) / 2, all};
  Remaining means{};
  double sum = 0;
  std::size_t rank = 0;
  for (std::size_t k = 0; k < all; ++k) {
    sum += lengths[k];
    for (; rank < kRanks && k + 1 >= counts[rank]; ++rank) means[rank] = sum / static_cast<double>(k + 1);
  }
  return means;
}

/// A state check of a large body among many walls costs a hundred times as much as one of a small body in a room, so
/// work is counted in distance queries.
double NavigationSearch::work() const {
  return std::max(0.25 * static_cast<double>(tree_.state_checks()),
                  static_cast<double>(tree_.distance_queries()) / 1000);
}

double NavigationSearch::score(const ProjectionCell& cell, std::size_t rank) const {
  return cell.remaining[rank] + longest_step() / parameters_.visits_per_step * static_cast<double>(cell.visits[rank]);
}

void NavigationSearch::insert(std::uint32_t node, const Remaining& remaining) {
  Key key;
  // Three points determine a rigid pose. The first ones are far from each other.
  for (std::size_t c = 0; c < std::min<std::size_t>(3, control_points_.size()); ++c) {
    const Vec3 p = tree_[node].pose * control_points_[c].center / projection_cell_size_;
    for (int k = 0; k < 3; ++k) key.push_back(static_cast<std::int32_t>(std::floor(p[k])));
  }
  const auto [entry, is_new] = cell_of_key_.try_emplace(key, static_cast<std::uint32_t>(cells_.size()));
  const std::uint32_t id = entry->second;
  if (is_new) {
    ProjectionCell cell;
    cell.remaining = remaining;
    cell.best.fill(node);
    cells_.push_back(std::move(cell));
    for (std::size_t r = 0; r < kRanks; ++r) cells_by_score_[r].insert({score(cells_[id], r), id});
  }
  ProjectionCell& cell = cells_[id];
  ++cell.size;
  for (std::size_t r = 0; r < kRanks; ++r) {
    if (!(remaining[r] < cell.remaining[r])) continue;
    cells_by_score_[r].erase({score(cell, r), id});
    cell.remaining[r] = remaining[r];
    cell.best[r] = node;
    cells_by_score_[r].insert({score(cell, r), id});
  }
  // Reservoir sampling: each node of the cell is among the 8 that are kept with the same probability. That bounds
  // memory.
  if (cell.nodes.size() < 8)
    cell.nodes.push_back(node);
  else if (const std::uint64_t at = rng_.below(cell.size); at < cell.nodes.size())
    cell.nodes[at] = node;
}

std::uint32_t NavigationSearch::select_node() {
  const std::size_t rank = rng_.below(kRanks);
  const std::uint32_t id = cells_by_score_[rank].begin()->second;
  cells_by_score_[rank].erase(cells_by_score_[rank].begin());
  ProjectionCell& cell = cells_[id];
  ++cell.visits[rank];
  cells_by_score_[rank].insert({score(cell, rank), id});
  return rng_.uniform() < parameters_.best_bias ? cell.best[rank] : cell.nodes[rng_.below(cell.nodes.size())];
}

/// Weights of the control points in one extension: all the same, or a bell around a random one. The others keep a small
/// weight, so that the fitted motion stays unique.
std::vector<double> NavigationSearch::sample_weights() {
  std::vector<double> weights(control_points_.size(), 1);
  if (rng_.uniform() < parameters_.uniform_weights) return weights;
  const Vec3 center = control_points_[rng_.below(control_points_.size())].center;
  const double width = tree_.radius() * rng_.uniform(0.2, 1);
  for (std::size_t k = 0; k < control_points_.size(); ++k)
    weights[k] = 0.02 + std::exp(-(control_points_[k].center - center).squaredNorm() / (width * width));
  return weights;
}

/// The rigid motion that best fits the directions of the navigation function at the control points. Points move by
/// about 1.
NavigationSearch::PoseTree::Step NavigationSearch::descent_step(std::uint32_t node,
                                                                const std::vector<double>& weights) const {
  std::vector<Vec3> points, directions;
  for (const MedialBall& p : control_points_) {
    points.push_back(tree_[node].pose * p.center);
    directions.push_back((navigation_.lookahead(points.back()) - points.back()).normalized());
  }
  const Twist twist = geometry::fitted_twist(points, directions, weights, tree_[node].center);
  const double size = std::max(twist.linear.norm() + tree_.radius() * twist.angular.norm(), 1e-12);
  return {twist.linear / size, twist.angular / size};
}

bool NavigationSearch::thin_and_moved(std::uint32_t node) const {
  return thin_ && (tree_[node].center - tree_.center()).norm() > parameters_.play_of_thin * tree_.radius();
}

bool NavigationSearch::is_goal(std::uint32_t node, const Remaining& remaining) {
  thin_moved_ = thin_moved_ || thin_and_moved(node);
  if (remaining.back() < best_remaining_) best_ = node, best_remaining_ = remaining.back();
  for (std::size_t r = 0; r < kRanks; ++r)
    if (remaining[r] < least_[r] - longest_step()) {
      progress_at_ = work();
      least_[r] = remaining[r];
      tree_.note_progress();
    }
  // The hulls are compared only once for each half of a longest step along the route.
  if (remaining.back() > goal_checked_at_ - 0.5 * longest_step()) return false;
  goal_checked_at_ = remaining.back();
  return tree_.separated(tree_[node].pose);
}

/// A step along a slippable motion of the body. Points move by about 1.
NavigationSearch::PoseTree::Step NavigationSearch::slippage_step(std::uint32_t node, const Twist& motion) const {
  const Eigen::Quaterniond& q = tree_[node].pose.q;
  return {q * motion.linear, q * motion.angular};
}

/// Extends one node by steps that descend the navigation function, follow a slippable motion, or are random. One random
/// step is drawn per extension and added to each step. Steps grow as long as the poses are valid.
bool NavigationSearch::extend() {
  std::uint32_t at = select_node();
  if (tree_[at].cut) return false;
  const auto in_cube = [&] { return Vec3(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
  // A helical part leaves a hole along its own screw.
  const Twist* slippage = !slippable_motions_.empty() && rng_.uniform() < parameters_.slippage_bias
                              ? &slippable_motions_[rng_.below(slippable_motions_.size())]
                              : nullptr;
  const double direction = slippage != nullptr && rng_.uniform() < 0.5 ? -1 : 1;
  const bool descends = slippage == nullptr && rng_.uniform() < parameters_.descent_bias;
  const std::vector<double> weights = sample_weights();
  // Narrow places need small steps.
  const double octaves = std::log2(parameters_.first_step_max / parameters_.first_step_min);
  const double size = parameters_.step * parameters_.first_step_max * std::exp2(-octaves * rng_.uniform());
  const double noise = descends ? rng_.uniform() * rng_.uniform() : slippage != nullptr ? 0.1 * rng_.uniform() : 1;
  const double turning = rng_.uniform();
  const Vec3 translation = noise * (1 - turning) * in_cube(), rotation = noise * turning / tree_.radius() * in_cube();
  const auto longest = static_cast<std::uint64_t>(parameters_.extension_steps);
  // A random direction is soon blocked, or leads nowhere: such extensions have a random, shorter length.
  const std::uint64_t steps =
      descends || slippage != nullptr ? longest : 1 + rng_.below(std::max<std::uint64_t>(1, longest / 10));
  const double max_scale = longest_step() / size;
  double scale = 1;
  for (std::uint64_t k = 0; k < steps && !tree_.halted(); ++k) {
    PoseTree::Step step{translation, rotation};
    if (descends) {
      const PoseTree::Step down = descent_step(at, weights);
      step.translation += down.translation;
      step.rotation += down.rotation;
    }
    if (slippage != nullptr) {
      const PoseTree::Step along = slippage_step(at, *slippage);
      step.translation += direction * along.translation;
      step.rotation += direction * along.rotation;
    }
    const Pose next = tree_.extended(at, step, scale * size);
    if (!tree_.state_valid(next)) {
      if (k == 0 || scale <= 1) break;
      scale = 1;
      continue;
    }
    at = tree_.add(next, at);
    const Remaining lengths = remaining(next);
    insert(at, lengths);
    if (is_goal(at, lengths)) {
      if (tree_.find_verified_path(at, result_)) return true;
      rebuild_cells();
      // The refusal may have cut off most of the tree, so the limits count from here.
      first_check_ = state_checks();
      first_work_ = work();
      return false;
    }
    scale = std::min(max_scale, parameters_.step_growth * scale);
  }
  return false;
}

/// True if the search is unlikely to get further. Takes a detour first if the progress so far justifies one.
bool NavigationSearch::should_give_up() {
  const bool play = !thin_moved_ && at_start_.back() - best_remaining_ < parameters_.play * tree_.radius();
  only_play_ = only_play_ && play;
  if (play && state_checks() >= first_check_ + static_cast<std::uint64_t>(parameters_.play_checks)) return true;
  bool worthwhile = thin_moved_;  // a thin body that is threaded through something makes no progress for a long time
  for (std::size_t r = 0; r < kRanks; ++r)
    worthwhile =
        worthwhile || at_start_[r] - least_[r] > std::min(parameters_.min_progress * at_start_[r], 2 * tree_.radius());
  const bool stuck = work() >= progress_at_ + effort_.patience;
  if (!worthwhile && (stuck || work() >= first_work_ + 2 * effort_.patience)) return true;
  return stuck && (++detours_ > effort_.detours || !detour());
}

SearchStatus NavigationSearch::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  const std::uint64_t most = query_.budget.max_steps > 0 ? query_.budget.max_steps : ~std::uint64_t{0};
  const std::uint64_t until = path::end_of_portion(state_checks(), portion.max_steps, most);
  const Deadline end = path::deadline_of(portion);
  bool solved = false;
  if (!std::exchange(begun_, true)) {
    progress_at_ = work();
    at_start_ = remaining(Pose{});
    // The best node of the resumed tree may be separated now that parts have left.
    if (resumed_ && has_route_out_ && best_ != 0 && tree_.separated(tree_[best_].pose)) {
      solved = tree_.find_verified_path(best_, result_);
      if (!solved) rebuild_cells();
    }
  }
  const auto over = [&] {
    return over_ || !has_route_out_ || state_checks() >= most || work() >= parameters_.max_work * effort_.patience ||
           tree_.halted() || tree_.given_up();
  };
  while (!solved && state_checks() < until && !over() && !end.passed()) {
    solved = extend();
    over_ = !solved && should_give_up();
  }
  if (!solved) tree_.set_failure(result_);
  if (!solved && !over()) return SearchStatus::paused;
  return status_of(result_.outcome());
}

PathResult NavigationSearch::result() {
  PathResult result = result_;
  tree_.fill(best_, result);
  result.stats.extra["detours"] = detours_;
  result.stats.extra["left"] = best_remaining_;
  return result;
}

}  // namespace dismantle::free_space
