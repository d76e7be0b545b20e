#include "dismantle/plugin.h"
#include "search.h"

namespace dismantle::bfs {
namespace {

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

class Bfs final : public PathPlanner {
 public:
  explicit Bfs(const Parameters& parameters) : parameters_(parameters) {}

  Capabilities needs() const noexcept override { return required(); }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || !has.contacts || has.max_moving < query.cast.moving.size()) {
      PathResult result;
      result.outcome = Outcome::unsupported;
      result.message = "bfs needs a simulator with dynamics and contacts for all moving parts";
      return result;
    }
    const Deadline deadline = query.effort.timeout > 0 ? Deadline::after_seconds(query.effort.timeout) : Deadline();
    std::uint64_t steps_left = query.effort.max_steps;
    const bool limited = query.effort.max_steps > 0;

    PathResult first;
    const bool translate = parameters_.motion != Motion::rotation;
    if (translate) {
      first = Search(query, MotionSpace::translation, parameters_, context).run(deadline, steps_left, limited, 0);
      if (parameters_.motion == Motion::translation || first.outcome != Outcome::exhausted) return first;
    }
    // Under a depth limit the first level stays cheap: most parts that do not move at all are simply blocked.
    const unsigned depth = query.effort.max_depth;
    if (translate && depth == 1) {
      first.outcome = Outcome::depth_limit;
      return first;
    }
    const std::uint64_t nodes =
        translate && depth > 0 ? static_cast<std::uint64_t>(parameters_.rotation_nodes) * depth : 0;
    PathResult second =
        Search(query, MotionSpace::rigid, parameters_, context).run(deadline, steps_left, limited, nodes);
    for (const auto& [name, value] : first.counts) second.counts[name] += value;
    if (second.message.empty()) second.message = first.message;
    return second;
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::bfs

DISMANTLE_PLUGIN("dismantle.bfs", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::bfs::Bfs, dismantle::bfs::Parameters>(
      "bfs", "Breadth-first search over a few forces and torques in a physics simulator.",
      {.source = "Tian et al. 2022, Algorithm 1", .needs = dismantle::bfs::required()});
}
