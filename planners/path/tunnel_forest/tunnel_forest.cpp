#include <algorithm>
#include <cmath>

#include "dismantle/plugin.h"
#include "growth.h"

namespace dismantle::tunnel_forest {
namespace {

class TunnelForest final : public FunctionPathPlanner {
 public:
  explicit TunnelForest(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds}; }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || !has.distance || has.max_moving < query.cast.moving.size())
      return PathResult::failure(Outcome::unsupported,
                                 "needs a simulator with dynamics and distances for all moving parts");
    return Growth(parameters_, query, context).run(level_limit(query.budget.max_depth));
  }

 private:
  std::uint64_t level_limit(unsigned depth) const {
    if (depth == 0) return kNoLimit;
    const double steps =
        std::ldexp(static_cast<double>(parameters_.level_steps), static_cast<int>(std::min(depth, 60u)) - 1);
    return steps < 1e18 ? static_cast<std::uint64_t>(steps) : kNoLimit;
  }

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
