#include <algorithm>
#include <cmath>

#include "dismantle/plugin.h"
#include "dismantle/tolerant_walk/walk.h"

namespace dismantle::squeeze {
namespace {

class Squeeze final : public FunctionPathPlanner {
 public:
  explicit Squeeze(const tolerant_walk::Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = tolerant_walk::kNeeds, .concurrent = true, .resumable = true};
  }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    tolerant_walk::Walk walk(parameters_, query, context, cache_);
    return walk.run(limit(query.budget.max_depth));
  }

 private:
  std::uint64_t limit(unsigned depth) const {
    const auto most = static_cast<std::uint64_t>(parameters_.looks);
    if (depth == 0) return most;
    const double looks =
        std::ldexp(static_cast<double>(parameters_.level_looks), static_cast<int>(std::min(depth, 60u)) - 1);
    return std::min(most, looks < 1e18 ? static_cast<std::uint64_t>(looks) : most);
  }

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
