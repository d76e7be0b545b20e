#include <algorithm>
#include <memory>

#include "dismantle/plugin.h"
#include "dismantle/search/growing_turns.h"
#include "dismantle/tolerant_walk/geometry_cache.h"
#include "dismantle/tolerant_walk/rrt_search.h"

namespace dismantle::tolerant_rrt {
namespace {

using tolerant_walk::Parameters;

class TolerantRrt final : public PathPlanner {
 public:
  explicit TolerantRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = tolerant_walk::kNeeds, .concurrent = true, .resumable = true};
  }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const std::uint64_t level = path::doubled_per_level(parameters_.level_state_checks, query.budget.max_depth);
    return std::make_unique<tolerant_walk::RrtSearch>(
        parameters_, query, context, *cache_, std::min(level, static_cast<std::uint64_t>(parameters_.state_checks)));
  }

 private:
  Parameters parameters_;
  std::shared_ptr<tolerant_walk::GeometryCache> cache_ = tolerant_walk::GeometryCache::shared();
};

}  // namespace
}  // namespace dismantle::tolerant_rrt

DISMANTLE_PLUGIN("dismantle.tolerant_rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::tolerant_rrt::TolerantRrt, dismantle::tolerant_walk::Parameters>(
      "tolerant_rrt",
      "A random tree of poses that may penetrate as deeply as the verifier tolerates: snap fits, pressed parts.",
      {.source = "LaValle 1998 (random trees), in the space that the tolerance leaves",
       .needs = dismantle::tolerant_walk::kNeeds});
}
