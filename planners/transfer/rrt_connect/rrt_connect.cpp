#include <optional>
#include <utility>

#include "dismantle/plugin.h"
#include "dismantle/plugin/late_library.h"
#include "dismantle/search/candidates.h"
#include "parameters.h"
#include "straight.h"
#include "trees.h"

namespace dismantle::rrt_connect {
namespace {

class RrtConnect final : public TransferPlanner {
 public:
  explicit RrtConnect(const Parameters& parameters) : parameters_(parameters) {}

  /// None: straight candidates need no simulator. Trees need one, and plan() reports if it does not suffice.
  Capabilities needs() const noexcept override { return {}; }

  PathResult plan(const TransferQuery& query, RunContext& context) override {
    PathResult result;
    Pose goal;
    if (!displacement_to_goal(query, goal)) {
      result.fail(Outcome::unsupported, "the goal is not a rigid displacement of the group");
      return result;
    }
    if (parameters_.straight_first && goes_straight(query, context, result)) return result;
    const Capabilities has = query.simulator.capabilities();
    if (!has.distance || has.max_moving < query.scene.moving.size()) {
      result.fail(Outcome::unsupported,
                  "no straight path, and trees need a simulator with distance queries for all moving parts");
      return result;
    }
    const auto grow =
        late_function<decltype(dismantle_connect_by_trees)>(DISMANTLE_TRANSFER_TREES, "dismantle_connect_by_trees");
    grow(parameters_, query, goal, context, result);
    return result;
  }

 private:
  bool goes_straight(const TransferQuery& query, RunContext& context, PathResult& result) {
    const StraightTransfers straight(query, parameters_.clearance, boxes_);
    std::uint64_t refused = 0;  // not in the statistics: these count only paths of trees
    std::size_t instants = 0;
    return path::show_forms(
               query.checker, refused,
               [&](std::size_t k) -> std::optional<Path> {
                 if (context.should_stop()) return std::nullopt;
                 std::optional<Path> path = straight.path(k);
                 if (!path) return std::nullopt;
                 ++result.stats.extra["straight"];
                 instants = path->size();
                 return path;
               },
               [&](const PathCheck& check, const Path&) {
                 result.message = check.reason;
                 return true;
               },
               [&](VerifiedPath path) { result.solve(std::move(path), static_cast<unsigned>(instants - 1)); })
        .accepted;
  }

  Parameters parameters_;
  PartBoxes boxes_;
};

}  // namespace
}  // namespace dismantle::rrt_connect

DISMANTLE_PLUGIN("dismantle.rrt_connect", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::TransferPlanner, dismantle::rrt_connect::RrtConnect, dismantle::rrt_connect::Parameters>(
      "rrt_connect", "Straight over everything if that is free, else two trees that grow towards each other.",
      {.source = "Kuffner and LaValle 2000; Tian et al. 2022, section 4.4, Algorithm 3"});
}
