#include <algorithm>
#include <optional>

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
    std::uint64_t steps_left = query.effort.max_steps;
    Search::Limits limits;
    limits.deadline = query.effort.timeout > 0 ? Deadline::after_seconds(query.effort.timeout) : Deadline();
    limits.steps_left = query.effort.max_steps > 0 ? &steps_left : nullptr;
    const unsigned depth = query.effort.max_depth;
    if (parameters_.motion != Motion::automatic) {
      const auto space = parameters_.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid;
      return Search(query, space, parameters_, context).run(limits);
    }
    return depth > 0 ? up_to_depth(query, depth, limits, context) : without_end(query, limits, context);
  }

 private:
  /// Under a depth limit somebody asks for all parts in turn: most of them are blocked, and have to be found so soon.
  PathResult up_to_depth(const PathQuery& query, unsigned depth, Search::Limits limits, RunContext& context) const {
    Search translation(query, MotionSpace::translation, parameters_, context);
    const auto level = static_cast<std::uint64_t>(depth);
    limits.expansions = static_cast<std::uint64_t>(parameters_.translation_nodes) * level;
    limits.rank = depth;  // the first level: what the contacts leave free, and the axes
    PathResult first = translation.run(limits);
    if (first.outcome != Outcome::exhausted && first.outcome != Outcome::depth_limit) return first;
    if (depth == 1) {
      first.outcome = Outcome::depth_limit;  // what cannot move may still be turned
      return first;
    }
    limits.expansions = static_cast<std::uint64_t>(parameters_.rotation_nodes) * level;
    Search rotation(query, MotionSpace::rigid, parameters_, context);
    return merged(first, rotation.run(limits));
  }

  /// By turns, until both are exhausted: what is new to each kind of motion comes before the rest of the other.
  PathResult without_end(const PathQuery& query, Search::Limits limits, RunContext& context) const {
    Search translation(query, MotionSpace::translation, parameters_, context);
    std::optional<Search> rotation;
    PathResult first, second;
    first.outcome = second.outcome = Outcome::depth_limit;
    const auto goes_on = [](const PathResult& r) { return r.outcome == Outcome::depth_limit; };
    for (limits.rank = Search::kFirstRank; goes_on(first) || goes_on(second); ++limits.rank) {
      if (goes_on(first)) first = translation.run(limits);
      if (!goes_on(first) && first.outcome != Outcome::exhausted) return rotation ? merged(second, first) : first;
      if (!rotation) rotation.emplace(query, MotionSpace::rigid, parameters_, context);
      if (goes_on(second)) second = rotation->run(limits);
      if (!goes_on(second) && second.outcome != Outcome::exhausted) break;
    }
    return merged(first, second);
  }

  /// The result of the later search, with what the earlier one has counted and touched.
  static PathResult merged(const PathResult& earlier, PathResult later) {
    for (const auto& [name, value] : earlier.counts) later.counts[name] += value;
    for (const PartId part : earlier.blocked_by)
      if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
        later.blocked_by.push_back(part);
    if (later.message.empty() && later.outcome != Outcome::solved) later.message = earlier.message;
    return later;
  }

  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::bfs

DISMANTLE_PLUGIN("dismantle.bfs", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::bfs::Bfs, dismantle::bfs::Parameters>(
      "bfs", "Breadth-first search over a few forces and torques in a physics simulator.",
      {.source = "Tian et al. 2022, Algorithm 1", .needs = dismantle::bfs::required()});
}
