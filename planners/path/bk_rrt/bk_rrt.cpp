#include <algorithm>
#include <memory>
#include <vector>

#include "dismantle/path/touched.h"
#include "dismantle/plugin.h"
#include "dismantle/search/ended_search.h"
#include "dismantle/search/growing_turns.h"
#include "dismantle/search/time_limit.h"
#include "random_tree.h"

namespace dismantle::bk_rrt {
namespace {

constexpr Capabilities kNeeds{.dynamics = true};

class BkRrtSearch final : public PathSearch {
 public:
  BkRrtSearch(const Parameters& parameters, const PathQuery& query, RunContext& context)
      : parameters_(parameters),
        query_(query),
        context_(context),
        deadline_(path::deadline_of(query, context)),
        level_(path::doubled_per_level(parameters.level_steps, query.budget.max_depth)),
        turns_(parameters.motion == Motion::automatic ? 2 : 1, static_cast<std::uint64_t>(parameters.first_turn)) {
    if (parameters.motion != Motion::rotation) add(MotionSpace::translation, 1);
    if (parameters.motion != Motion::translation) add(MotionSpace::rigid, 2);
  }

  SearchStatus run(const Budget& portion) override {
    if (is_success(result_.outcome())) return SearchStatus::solved;
    if (used() == 0 && trees_.front()->starts_separated()) {
      result_.start_is_goal();
      return SearchStatus::solved;
    }
    const Deadline end = path::deadline_of(portion);
    const std::uint64_t until = path::end_of_portion(used(), portion.max_steps, level_);
    turns_.run(
        until, [&] { return used(); },
        [&](std::size_t tree, std::uint64_t share) {
          while (used() < share)
            if (stopped() || end.passed() || trees_[tree]->iterate(result_)) return true;
          return false;
        });
    if (is_success(result_.outcome())) return SearchStatus::solved;
    result_.fail(context_.cancel.cancelled() ? Outcome::cancelled
                 : stopped()                 ? Outcome::timeout
                                             : Outcome::depth_limit);
    if (stopped() || used() >= level_) return status_of(result_.outcome());
    return SearchStatus::paused;
  }

  PathResult result() override {
    PathResult result = result_;
    if (!result.path() && result.outcome() != Outcome::start_is_goal) {
      const auto& best = *std::max_element(trees_.begin(), trees_.end(), [](const auto& a, const auto& b) {
        return a->farthest_distance() < b->farthest_distance();
      });
      result.best_pose = best->farthest();
    }
    std::map<PartId, std::uint64_t> touched;
    for (const auto& tree : trees_) {
      result.stats += {.steps = tree->steps(),
                       .nodes = tree->size(),
                       .refused = tree->refused(),
                       .cost = static_cast<double>(tree->steps())};
      for (const auto& [part, times] : tree->touched()) touched[part] += times;
    }
    result.blocked_by = path::most_touched(touched, query_.scene.moving);
    return result;
  }

 private:
  void add(MotionSpace motion, std::uint64_t stream) {
    trees_.push_back(std::make_unique<RandomTree>(query_, motion, parameters_, context_, context_.rng.fork(stream)));
  }
  std::uint64_t used() const {
    std::uint64_t steps = 0;
    for (const auto& t : trees_) steps += t->steps();
    return steps;
  }
  bool stopped() const {
    return context_.should_stop() || deadline_.passed() ||
           (query_.budget.max_steps > 0 && used() >= query_.budget.max_steps);
  }

  const Parameters parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Deadline deadline_;
  std::uint64_t level_;  ///< simulated steps that the depth limit allows
  path::GrowingTurns turns_;
  std::vector<std::unique_ptr<RandomTree>> trees_;
  PathResult result_;
};

class BkRrt final : public PathPlanner {
 public:
  explicit BkRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds}; }

  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || has.max_moving < query.scene.moving.size())
      return path::unsupported("needs a simulator with dynamics for all moving parts");
    return std::make_unique<BkRrtSearch>(parameters_, query, context);
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::bk_rrt

DISMANTLE_PLUGIN("dismantle.bk_rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::bk_rrt::BkRrt, dismantle::bk_rrt::Parameters>(
      "bk_rrt", "Behavioural kinodynamic RRT: random actions in a physics simulator.",
      {.source = "Zickler and Veloso 2009; Tian et al. 2022, Algorithm 4", .needs = dismantle::bk_rrt::kNeeds});
}
