#include "dismantle/plugin.h"
#include "dismantle/push/plan.h"
#include "parameters.h"

namespace dismantle::guided {
namespace {

class Guided final : public PathPlanner {
 public:
  explicit Guided(const Parameters& parameters) : tactics_(parameters.tactics()) {}

  Capabilities needs() const noexcept override { return push::required(); }
  PathResult plan(const PathQuery& query, RunContext& context) override { return push::plan(query, tactics_, context); }

 private:
  push::Tactics tactics_;
};

}  // namespace
}  // namespace dismantle::guided

DISMANTLE_PLUGIN("dismantle.guided", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::guided::Guided, dismantle::guided::Parameters>(
      "guided", "Search over pushes, turns and screws that the contacts propose, in a physics simulator.",
      {.source = "Tian et al. 2022, Algorithm 1, with actions proposed by geometry",
       .needs = dismantle::push::required()});
}
