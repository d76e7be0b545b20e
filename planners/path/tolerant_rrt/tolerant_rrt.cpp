#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "dismantle/plugin.h"
#include "dismantle/tolerant_walk/geometry_cache.h"
#include "dismantle/tolerant_walk/walk.h"

namespace dismantle::tolerant_rrt {
namespace {

using tolerant_walk::Parameters;

class Search final : public PathSearch {
 public:
  Search(const Parameters& parameters, tolerant_walk::GeometryCache& cache, const PathQuery& query, RunContext& context)
      : parameters_(parameters), cache_(cache), query_(query), context_(context) {}

  SearchStatus run(const Budget& portion) override {
    if (status_ != SearchStatus::paused) return status_;
    if (!walk_) walk_.emplace(parameters_, query_, context_, cache_);
    const Deadline pause_at = portion.timeout > 0 ? Deadline::after_seconds(portion.timeout) : Deadline();
    last_ = walk_->run(most_looks(), portion.max_steps, pause_at);
    return status_ = walk_->paused() ? SearchStatus::paused : status_of(last_.outcome());
  }
  PathResult result() override { return last_; }

 private:
  std::uint64_t most_looks() const {
    const unsigned depth = query_.budget.max_depth;
    const auto most = static_cast<std::uint64_t>(parameters_.looks);
    if (depth == 0) return most;
    const double looks = std::ldexp(parameters_.level_looks, static_cast<int>(std::min(depth, 60u)) - 1);
    return std::min(most, looks < 1e18 ? static_cast<std::uint64_t>(looks) : most);
  }

  const Parameters& parameters_;
  tolerant_walk::GeometryCache& cache_;
  const PathQuery& query_;
  RunContext& context_;
  std::optional<tolerant_walk::Walk> walk_;
  PathResult last_ = PathResult::failure(Outcome::depth_limit);
  SearchStatus status_ = SearchStatus::paused;
};

class TolerantRrt final : public PathPlanner {
 public:
  explicit TolerantRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = tolerant_walk::kNeeds, .concurrent = true, .resumable = true};
  }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return std::make_unique<Search>(parameters_, *cache_, query, context);
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
      "A random tree of poses that may penetrate as deep as the verifier tolerates: snap fits, pressed parts.",
      {.source = "LaValle 1998 (random trees), in the space that the tolerance leaves",
       .needs = dismantle::tolerant_walk::kNeeds});
}
