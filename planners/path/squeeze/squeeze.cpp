#include <algorithm>
#include <memory>

#include "dismantle/path/growing_turns.h"
#include "dismantle/plugin.h"
#include "dismantle/tolerant_walk/walk.h"

namespace dismantle::squeeze {
namespace {

class Squeeze final : public PathPlanner {
 public:
  explicit Squeeze(const tolerant_walk::Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = tolerant_walk::kNeeds, .concurrent = true, .resumable = true};
  }

  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const std::uint64_t level = path::doubled_per_level(parameters_.level_looks, query.budget.max_depth);
    return std::make_unique<tolerant_walk::Walk>(parameters_, query, context, cache_,
                                                 std::min(level, static_cast<std::uint64_t>(parameters_.looks)));
  }

 private:
  tolerant_walk::Parameters parameters_;
  tolerant_walk::GeometryCache cache_;
};

}  // namespace
}  // namespace dismantle::squeeze

DISMANTLE_PLUGIN("dismantle.squeeze", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::squeeze::Squeeze, dismantle::tolerant_walk::Parameters>(
      "squeeze", "A random tree of poses that may penetrate as deep as the judge allows: snap fits, pressed parts.",
      {.source = "LaValle 1998 (random trees), in the space that the tolerance leaves",
       .needs = dismantle::tolerant_walk::kNeeds});
}
