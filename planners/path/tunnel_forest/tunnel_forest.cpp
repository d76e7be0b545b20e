#include <memory>

#include "dismantle/plugin.h"
#include "dismantle/search/ended_search.h"
#include "dismantle/search/growing_turns.h"
#include "forest_search.h"

namespace dismantle::tunnel_forest {
namespace {

class TunnelForest final : public PathPlanner {
 public:
  explicit TunnelForest(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds, .concurrent = true}; }

  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || !has.distance || has.max_moving < query.scene.moving.size())
      return path::unsupported("needs a simulator with dynamics and distances for all moving parts");
    return std::make_unique<ForestSearch>(parameters_, query, context,
                                          path::doubled_per_level(parameters_.level_steps, query.budget.max_depth));
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::tunnel_forest

DISMANTLE_PLUGIN("dismantle.tunnel_forest", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::tunnel_forest::TunnelForest, dismantle::tunnel_forest::Parameters>(
      "tunnel_forest", "Trees from the start and from matching narrow places that grow along contact and are joined.",
      {.source = "Zhang and Manocha 2008 (retraction), Zhang et al. 2020 (tunnels); see its README",
       .needs = dismantle::tunnel_forest::kNeeds});
}
