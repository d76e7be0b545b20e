#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "dismantle/plugin.h"
#include "growth.h"

namespace dismantle::tunnel_forest {
namespace {

class Search final : public PathSearch {
 public:
  Search(const Parameters& parameters, const PathQuery& query, RunContext& context)
      : parameters_(parameters), query_(query), context_(context) {}

  SearchStatus run(const Budget& portion) override {
    if (status_ == SearchStatus::paused) status_ = run_on(portion);
    return status_;
  }
  PathResult result() override { return last_; }

 private:
  SearchStatus run_on(const Budget& portion) {
    const Capabilities has = query_.simulator.capabilities();
    if (!has.dynamics || !has.distance || has.max_moving < query_.cast.moving.size()) {
      last_.fail(Outcome::unsupported, "needs a simulator with dynamics and distances for all moving parts");
      return SearchStatus::failed;
    }
    if (!growth_) growth_.emplace(parameters_, query_, context_);
    const std::uint64_t most = most_steps();
    std::uint64_t until = most;
    if (portion.max_steps > 0 && portion.max_steps < most - growth_->used())
      until = growth_->used() + portion.max_steps;
    const Deadline pause_at = portion.timeout > 0 ? Deadline::after_seconds(portion.timeout) : Deadline();
    last_ = growth_->run(until, pause_at);
    if (last_.outcome() == Outcome::depth_limit && growth_->used() < most) return SearchStatus::paused;
    return status_of(last_.outcome());
  }

  std::uint64_t most_steps() const {
    const std::uint64_t most = parameters_.max_steps > 0 ? static_cast<std::uint64_t>(parameters_.max_steps) : kNoLimit;
    const unsigned depth = query_.budget.max_depth;
    if (depth == 0) return most;
    const double steps =
        std::ldexp(static_cast<double>(parameters_.level_steps), static_cast<int>(std::min(depth, 60u)) - 1);
    return steps < 1e18 ? std::min(most, static_cast<std::uint64_t>(steps)) : most;
  }

  const Parameters& parameters_;
  const PathQuery& query_;
  RunContext& context_;
  std::optional<Growth> growth_;
  PathResult last_ = PathResult::failure(Outcome::depth_limit);
  SearchStatus status_ = SearchStatus::paused;
};

class TunnelForest final : public PathPlanner {
 public:
  explicit TunnelForest(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds, .concurrent = true}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return std::make_unique<Search>(parameters_, query, context);
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::tunnel_forest

DISMANTLE_PLUGIN("dismantle.tunnel_forest", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::tunnel_forest::TunnelForest, dismantle::tunnel_forest::Parameters>(
      "tunnel_forest", "Trees from the start and from narrow places that match, grown along contact, and joined.",
      {.source = "Zhang and Manocha 2008 (retraction), Zhang et al. 2020 (tunnels); see its README",
       .needs = dismantle::tunnel_forest::kNeeds});
}
