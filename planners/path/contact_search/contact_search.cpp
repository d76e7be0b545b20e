#include <memory>

#include "dismantle/executor.h"
#include "dismantle/plugin.h"
#include "dismantle/push_search/plan.h"
#include "parameters.h"

namespace dismantle::contact_search {
namespace {

class ContactSearch final : public PathPlanner {
 public:
  explicit ContactSearch(const Parameters& parameters) : tactics_(parameters.tactics()) {}

  PathPlannerTraits traits() const noexcept override {
    return {.needs = push::required(), .concurrent = true, .simultaneous_motion = true, .resumable = true};
  }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return push::start(query, tactics_, context, [&context] { pause_point(context); });
  }

 private:
  push::Tactics tactics_;
};

}  // namespace
}  // namespace dismantle::contact_search

DISMANTLE_PLUGIN("dismantle.contact_search", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::contact_search::ContactSearch, dismantle::contact_search::Parameters>(
      "contact_search", "Search over pushes, turns and screws that the contacts propose, in a physics simulator.",
      {.source = "Tian et al. 2022, Algorithm 1, with actions proposed by geometry",
       .needs = dismantle::push::required()});
}
