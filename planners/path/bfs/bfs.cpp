#include "dismantle/plugin.h"
#include "dismantle/push_search/plan.h"
#include "parameters.h"
#include "published.h"

namespace dismantle::bfs {
namespace {

class Bfs final : public PathPlanner {
 public:
  explicit Bfs(const Parameters& parameters) : parameters_(parameters), tactics_(parameters.tactics()) {}

  PathPlannerTraits traits() const noexcept override {
    return {.needs = push::required(), .simultaneous_motion = true, .resumable = true};
  }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const bool as_one = query.goal.any_of.empty();
    if (parameters_.variant == Variant::published && as_one && push::fits(query))
      return std::make_unique<PublishedSearch>(query, parameters_, context);
    return push::start(query, tactics_, context);
  }

 private:
  Parameters parameters_;
  push::Tactics tactics_;
};

}  // namespace
}  // namespace dismantle::bfs

DISMANTLE_PLUGIN("dismantle.bfs", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::bfs::Bfs, dismantle::bfs::Parameters>(
      "bfs", "Breadth-first search over a few forces and torques in a physics simulator.",
      {.source = "Tian et al. 2022, Algorithm 1", .needs = dismantle::push::required()});
}
