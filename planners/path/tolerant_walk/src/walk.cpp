#include "dismantle/tolerant_walk/walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/path/growing_turns.h"

namespace dismantle::tolerant_walk {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr int kLongestFlight = 400;     // steps
constexpr double kFaster = 1.15;        // each step of a flight is so much longer than the last ...
constexpr double kFastest = 10;         // ... up to so many times the first
constexpr double kOutward = 0.7;        // share of the steps from what is furthest out that lead further
constexpr double kStraight = 0.15;      // ... and of those the ones that do nothing else
constexpr double kOctaves = 2;          // between the largest and the smallest steps
constexpr double kRecent = 0.2;         // share of the steps from the newest nodes
constexpr std::uint64_t kNewest = 200;  // nodes
constexpr double kAskEvery = 0.05;      // assembly units from the start: whether it is out

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

Walk::Walk(const Parameters& parameters, const PathQuery& query, RunContext& context, GeometryCache& cache,
           std::uint64_t most_looks)
    : parameters_(parameters),
      query_(query),
      rng_(context.rng.fork(0x5c9ee2e)),
      tree_(parameters_, query, context, rng_, Overlap::everywhere, cache),
      most_looks_(query.budget.max_steps > 0 ? std::min(most_looks, query.budget.max_steps) : most_looks) {
  const auto* reached = dynamic_cast<const PoseTree::Reached*>(query.resume_from);
  if (reached == nullptr || !reached->has_room_now(query.scene)) return;
  tree_.resume(*reached);
  resumed_ = true;
  most_looks_ -= std::min(tree_.spared(), most_looks_ / 2);
  note_all();
}

/// Of those that are not cut.
void Walk::note_all() {
  furthest_.fill(0);
  for (std::uint32_t n = 1; n < tree_.size(); ++n)
    if (!tree_[n].cut) note(n);
}

void Walk::note(std::uint32_t node) {
  for (std::size_t d = 0; d < furthest_.size(); ++d)
    if (directions()[d].dot(tree_[node].center) > directions()[d].dot(tree_[furthest_[d]].center)) furthest_[d] = node;
}

/// Where to go on, and how.
std::uint32_t Walk::choose(PoseTree::Step& step) {
  const auto in_cube = [&] { return Vec3(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
  const double kind = rng_.uniform();
  const std::uint64_t count = tree_.size();
  Vec3 outward = Vec3::Zero();
  std::uint64_t from = 0;
  if (kind < parameters_.outward) {
    const auto d = static_cast<std::size_t>(rng_.below(furthest_.size()));
    from = furthest_[d];
    if (rng_.uniform() < kOutward) outward = 1.5 * rng_.uniform() * directions()[d];
  } else if (kind < parameters_.outward + kRecent * (1 - parameters_.outward)) {
    from = count - 1 - rng_.below(std::min(count, kNewest));
  } else {
    from = rng_.below(count);
  }
  // Narrow places ask for small steps.
  const double size = parameters_.step * std::exp2(-kOctaves * rng_.uniform());
  const bool straight = !outward.isZero() && rng_.uniform() < kStraight;
  step.way = size * (straight ? outward : Vec3(outward + rng_.uniform() * in_cube()));
  step.turn = straight ? Vec3(Vec3::Zero()) : Vec3(size / tree_.radius() * in_cube());
  return static_cast<std::uint32_t>(from);
}

/// The same step again and again, longer and longer, while nothing is in the
/// way.
bool Walk::fly() {
  PoseTree::Step step;
  std::uint32_t at = choose(step);
  if (tree_[at].cut) return false;
  const double length = std::max(step.way.norm(), tree_.radius() * step.turn.norm());
  const double fastest = kFastest * parameters_.step / std::max(length, 1e-12);
  double faster = 1;
  for (int k = 0; k < kLongestFlight && !tree_.halted(); ++k) {
    const Pose next = tree_.after(at, step, faster);
    if (!tree_.allowed(next)) {
      if (k == 0 || faster <= 1) break;
      faster = 1;  // perhaps it was only too fast
      continue;
    }
    at = tree_.add(next, at);
    note(at);
    if (out(at)) return verified(at);
    faster = std::min(fastest, kFaster * faster);
  }
  return false;
}

bool Walk::out(std::uint32_t node) {
  const double far = (tree_[node].center - tree_.center()).norm();
  if (far < looked_at_ + kAskEvery) return false;
  looked_at_ = far;
  return tree_.separated(tree_[node].pose);
}

bool Walk::verified(std::uint32_t node) {
  looked_at_ = 0;
  if (tree_.verified(node, result_)) return true;
  note_all();
  return false;
}

SearchStatus Walk::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  if (!std::exchange(begun_, true) && tree_.separated(Pose{})) {
    result_.start_is_goal();
    return SearchStatus::solved;
  }
  const Deadline end = portion.timeout > 0 ? Deadline::after_seconds(portion.timeout) : Deadline();
  const std::uint64_t until = path::end_of_portion(looks(), portion.max_steps, most_looks_);
  bool solved = false;
  if (std::exchange(resumed_, false))  // what was in the way there may have left
    for (const std::uint32_t n : std::array(furthest_))
      if (!solved && !tree_.halted() && !tree_[n].cut && tree_.separated(tree_[n].pose)) solved = verified(n);
  const auto over = [&] { return looks() >= most_looks_ || tree_.halted() || tree_.given_up(); };
  while (!solved && looks() < until && !over() && !end.passed()) solved = fly();
  if (!solved) tree_.explain(result_);
  if (!solved && !over()) return SearchStatus::paused;
  return status_of(result_.outcome());
}

PathResult Walk::result() {
  PathResult result = result_;
  if (result.outcome() == Outcome::start_is_goal) return result;
  std::uint32_t best = 0;
  for (const std::uint32_t n : furthest_)
    if ((tree_[n].center - tree_.center()).norm() > (tree_[best].center - tree_.center()).norm()) best = n;
  tree_.finish(best, result);
  return result;
}

}  // namespace dismantle::tolerant_walk
