#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "dismantle/free_space/navigation_search.h"
#include "dismantle/path/time_limit.h"
#include "dismantle/plugin.h"
#include "dismantle/tolerant_walk/geometry_cache.h"
#include "dismantle/tolerant_walk/rrt_search.h"
#include "parameters.h"

namespace dismantle::navigation_tree {
namespace {

using tolerant_walk::Overlap;

/// The states of the searches when they stopped; null for a search that was not made or did not begin.
class State final : public SearchState {
 public:
  std::shared_ptr<const SearchState> tree, near_start;
};

bool unsuccessful(const PathResult& r) {
  return r.outcome() == Outcome::depth_limit || r.outcome() == Outcome::exhausted;
}

/// Makes one search; for a group that is thinner than its initial overlap, two. The first allows that overlap near the
/// start only, because elsewhere it would let paths lead through walls. If the group then shows only some play, it may
/// be held with interference along its whole path, and the second search allows the overlap everywhere.
class Search final : public PathSearch {
 public:
  Search(const Parameters& parameters, tolerant_walk::GeometryCache& cache, const PathQuery& query, RunContext& context)
      : parameters_(parameters), cache_(cache), query_(query), context_(context) {
    const std::int64_t depth = query.budget.max_depth;
    const auto halvings = depth > 0 ? std::max<std::int64_t>(0, parameters.full_depth - depth) : 0;
    patience_ = std::ldexp(static_cast<double>(parameters.patience), -static_cast<int>(halvings));
    detours_ = static_cast<unsigned>(parameters.detours >> halvings);
  }

  SearchStatus run(const Budget& portion) override {
    if (status_ == SearchStatus::paused) status_ = patience_ > 0 ? run_on(portion) : SearchStatus::exhausted;
    return status_;
  }

  PathResult result() override {
    PathResult result = last_;
    result.stats += first_stats_;
    if (is_success(result.outcome())) return result;
    auto state = std::make_shared<State>();
    state->tree = tree_state_;
    state->near_start = near_start_state_;
    result.state = std::move(state);
    return result;
  }

 private:
  SearchStatus run_on(const Budget& portion) {
    const Deadline end = path::deadline_of(portion);
    if (!tree_) {
      thin_ = free_space::thinner_than_overlap(query_, parameters_.control_points);
      begin(thin_ ? Overlap::near_start : Overlap::everywhere);
    }
    if (tree_->starts_separated()) {
      last_.start_is_goal();
      return SearchStatus::solved;
    }
    const std::uint64_t begun_at = used();
    while (true) {
      if (tree_->has_route_out() && left_of_budget() > 0) {
        Budget own{.timeout = portion.timeout > 0 ? std::max(1e-9, end.seconds_left()) : 0};
        if (portion.max_steps > 0)
          own.max_steps =
              std::max<std::uint64_t>(1, portion.max_steps - std::min(portion.max_steps, used() - begun_at));
        const SearchStatus status = tree_->run(own);
        last_ = tree_->result();
        (near_start_ ? near_start_state_ : tree_state_) = last_.state;
        if (status == SearchStatus::paused) return status;
      }
      if (unsuccessful(last_) && context_.cancel.cancelled()) last_.fail(Outcome::cancelled);
      if (unsuccessful(last_) && left_of_budget() == 0) last_.fail(Outcome::timeout);
      if (!near_start_ || !unsuccessful(last_) || !tree_->only_play()) return status_of(last_.outcome());
      before_ += tree_->state_checks();
      first_stats_ = std::exchange(last_.stats, {});
      first_stats_.extra.clear();  // the remaining distances of two searches do not add up
      begin(Overlap::everywhere);
    }
  }

  void begin(Overlap overlap) {
    near_start_ = overlap == Overlap::near_start;
    const auto* state = dynamic_cast<const State*>(query_.resume_from);
    PathQuery own = query_;
    own.resume_from = state != nullptr ? (near_start_ ? state->near_start : state->tree).get() : nullptr;
    if (query_.budget.max_steps > 0)  // the first search has used its share
      own.budget.max_steps =
          std::max<std::uint64_t>(1, query_.budget.max_steps - std::min(query_.budget.max_steps, before_));
    tree_.reset();
    own_query_.emplace(own);
    tree_.emplace(parameters_.search(thin_ && !near_start_), *own_query_, context_,
                  free_space::NavigationSearch::Effort{patience_, detours_}, overlap, cache_);
  }

  /// State checks of both searches.
  std::uint64_t used() const { return before_ + tree_->state_checks(); }
  std::uint64_t left_of_budget() const {
    if (query_.budget.max_steps == 0) return ~std::uint64_t{0};
    return query_.budget.max_steps - std::min(query_.budget.max_steps, used());
  }

  const Parameters& parameters_;
  tolerant_walk::GeometryCache& cache_;
  const PathQuery& query_;
  RunContext& context_;
  double patience_ = 0;
  unsigned detours_ = 0;
  bool thin_ = false, near_start_ = false;
  std::optional<PathQuery> own_query_;
  std::optional<free_space::NavigationSearch> tree_;
  std::uint64_t before_ = 0;  // state checks of the first search
  SearchStats first_stats_;
  PathResult last_ = PathResult::failure(Outcome::depth_limit);
  std::shared_ptr<const SearchState> tree_state_, near_start_state_;
  SearchStatus status_ = SearchStatus::paused;
};

class NavigationTree final : public PathPlanner {
 public:
  explicit NavigationTree(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = tolerant_walk::kNeeds, .concurrent = true, .resumable = true};
  }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return std::make_unique<Search>(parameters_, *cache_, query, context);
  }

 private:
  Parameters parameters_;
  std::shared_ptr<tolerant_walk::GeometryCache> cache_ = tolerant_walk::GeometryCache::shared();
};

}  // namespace
}  // namespace dismantle::navigation_tree

DISMANTLE_PLUGIN("dismantle.navigation_tree", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::navigation_tree::NavigationTree, dismantle::navigation_tree::Parameters>(
      "navigation_tree", "A random tree of poses that follows the free space between the fixed parts to the outside.",
      {.source = "Barraquand and Latombe 1991 (random search along potential fields); see its README",
       .needs = dismantle::tolerant_walk::kNeeds});
}
