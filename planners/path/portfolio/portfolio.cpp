#include <algorithm>
#include <memory>
#include <vector>

#include "dismantle/plugin.h"
#include "dismantle/search/ended_search.h"
#include "parameters.h"
#include "portfolio_search.h"

namespace dismantle::portfolio {
namespace {

class Portfolio final : public PathPlanner {
 public:
  explicit Portfolio(const Parameters& parameters) : parameters_(parameters) {
    for (const Member& member : parameters_.of) planners_.push_back(member.plugin.create());
    traits_.concurrent = true;
    for (const auto& planner : planners_) {
      const PathPlannerTraits one = planner->traits();
      traits_.concurrent = traits_.concurrent && one.concurrent;
      traits_.simultaneous_motion = traits_.simultaneous_motion || one.simultaneous_motion;
      traits_.resumable = traits_.resumable || one.resumable;
      traits_.needs.dynamics = traits_.needs.dynamics || one.needs.dynamics;
      traits_.needs.contacts = traits_.needs.contacts || one.needs.contacts;
      traits_.needs.distance = traits_.needs.distance || one.needs.distance;
      traits_.needs.max_moving = std::max(traits_.needs.max_moving, one.needs.max_moving);
    }
  }

  PathPlannerTraits traits() const noexcept override { return traits_; }

  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    // A portfolio without one of its members would be another planner under the same name.
    const Capabilities has = query.simulator.capabilities();
    for (std::size_t k = 0; k < planners_.size(); ++k) {
      const Capabilities needs = planners_[k]->traits().needs;
      if ((needs.dynamics && !has.dynamics) || (needs.contacts && !has.contacts) || (needs.distance && !has.distance))
        return path::unsupported("its member '" + parameters_.of[k].plugin.type() +
                                 "' needs capabilities that the simulator does not have; see 'dismantle plugins list'");
    }
    return std::make_unique<PortfolioSearch>(parameters_, planners_, query, context);
  }

 private:
  Parameters parameters_;
  std::vector<std::shared_ptr<PathPlanner>> planners_;
  PathPlannerTraits traits_;
};

}  // namespace
}  // namespace dismantle::portfolio

DISMANTLE_PLUGIN("dismantle.portfolio", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::portfolio::Portfolio, dismantle::portfolio::Parameters>(
      "portfolio", "Several path planners in one search: one after the other, or in turns that grow.",
      {.source = "Huberman, Lukose and Hogg 1997 (portfolios); Luby, Sinclair and Zuckerman 1993 (growing turns)"});
}
