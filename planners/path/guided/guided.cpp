#include <algorithm>

#include "dismantle/plugin.h"
#include "dismantle/push/plan.h"
#include "parameters.h"
#include "with_others.h"

namespace dismantle::guided {
namespace {

class Guided final : public FunctionPathPlanner {
 public:
  explicit Guided(const Parameters& parameters) : parameters_(parameters), tactics_(parameters.tactics()) {}

  PathPlannerTraits traits() const noexcept override {
    return {.needs = push::required(), .concurrent = true, .simultaneous_motion = true, .resumable = true};
  }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    // Walk and forest move a group as one.
    const bool others = (parameters_.forest_steps > 0 || parameters_.squeeze_looks > 0 || parameters_.lead_looks > 0) &&
                        parameters_.motion == push::Motion::automatic && can_grow(query) && query.goal.any_of.empty();
    return others ? plan_with_others(query, parameters_, tactics_, cache_, context)
                  : run_to_end(*push::start(query, tactics_, context));
  }

 private:
  static bool can_grow(const PathQuery& query) {
    const Capabilities has = query.simulator.capabilities();
    return has.dynamics && has.contacts && has.distance && has.max_moving >= query.cast.moving.size();
  }

  Parameters parameters_;
  push::Tactics tactics_;
  tolerant_walk::GeometryCache cache_;
};

}  // namespace
}  // namespace dismantle::guided

DISMANTLE_PLUGIN("dismantle.guided", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::guided::Guided, dismantle::guided::Parameters>(
      "guided",
      "Search over pushes, turns and screws that the contacts propose, in a physics simulator; then walks, and a "
      "forest.",
      {.source = "Tian et al. 2022, Algorithm 1, with actions proposed by geometry",
       .needs = dismantle::push::required()});
}
