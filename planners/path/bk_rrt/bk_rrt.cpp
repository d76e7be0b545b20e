#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/path/touched.h"
#include "dismantle/plugin.h"
#include "random_tree.h"

namespace dismantle::bk_rrt {
namespace {

constexpr Capabilities kNeeds{.dynamics = true};
/// Simulated steps of the first turn of a tree where two grow in turn; each round doubles it.
constexpr std::uint64_t kFirstTurn = 4'000;

class BkRrt final : public FunctionPathPlanner {
 public:
  explicit BkRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds}; }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    PathResult result;
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || has.max_moving < query.cast.moving.size())
      return PathResult::failure(Outcome::unsupported, "needs a simulator with dynamics for all moving parts");
    const Deadline deadline = query.budget.timeout > 0
                                  ? context.deadline.earlier(Deadline::after_seconds(query.budget.timeout))
                                  : context.deadline;
    std::vector<std::unique_ptr<RandomTree>> trees;
    const auto add = [&](MotionSpace motion, std::uint64_t stream) {
      trees.push_back(std::make_unique<RandomTree>(query, motion, parameters_, context.rng.fork(stream)));
    };
    if (parameters_.motion != Motion::rotation) add(MotionSpace::translation, 1);
    if (parameters_.motion != Motion::translation) add(MotionSpace::rigid, 2);
    if (trees.front()->starts_out()) {
      result.start_is_goal();
      return result;
    }

    const std::uint64_t budget = query.budget.max_steps > 0 ? query.budget.max_steps : kNone;
    const std::uint64_t level = level_limit(query.budget);
    const auto used = [&] {
      std::uint64_t steps = 0;
      for (const auto& t : trees) steps += t->steps();
      return steps;
    };
    bool solved = false, stopped = false;
    for (std::uint64_t turn = kFirstTurn; !solved && !stopped && used() < level; turn *= 2)
      for (const auto& tree : trees) {
        const std::uint64_t until = trees.size() > 1 ? std::min(level, used() + turn) : level;
        while (!solved && used() < until) {
          if (stopped = context.should_stop() || deadline.passed() || used() >= budget; stopped) break;
          solved = tree->iterate(result);
        }
        if (solved || stopped) break;
      }
    if (!solved) {
      result.fail(!stopped ? Outcome::depth_limit : context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout);
      const auto& best = *std::max_element(trees.begin(), trees.end(), [](const auto& a, const auto& b) {
        return a->farthest_way() < b->farthest_way();
      });
      result.best_pose = best->farthest();
    }
    finish(trees, query.cast.moving, result);
    return result;
  }

 private:
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t level_limit(const Budget& effort) const {
    if (effort.max_depth == 0) return kNone;
    const double steps =
        std::ldexp(static_cast<double>(parameters_.level_steps), static_cast<int>(std::min(effort.max_depth, 60u)) - 1);
    return steps < 1e18 ? static_cast<std::uint64_t>(steps) : kNone;
  }

  static void finish(const std::vector<std::unique_ptr<RandomTree>>& trees, const std::vector<PlacedPart>& moving,
                     PathResult& result) {
    std::map<PartId, std::uint64_t> touched;
    for (const auto& tree : trees) {
      result.stats += {.steps = tree->steps(),
                       .nodes = tree->size(),
                       .refused = tree->refused(),
                       .cost = static_cast<double>(tree->steps())};
      for (const auto& [part, times] : tree->touched()) touched[part] += times;
    }
    result.blocked_by = path::most_touched(touched, moving);
  }

  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::bk_rrt

DISMANTLE_PLUGIN("dismantle.bk_rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::bk_rrt::BkRrt, dismantle::bk_rrt::Parameters>(
      "bk_rrt", "Behavioural kinodynamic RRT: random actions in a physics simulator.",
      {.source = "Zickler and Veloso 2009; Tian et al. 2022, Algorithm 4", .needs = dismantle::bk_rrt::kNeeds});
}
