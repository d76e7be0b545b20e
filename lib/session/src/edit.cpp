#include "dismantle/session/edit.h"

#include <fmt/format.h>

#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dismantle/engine/run.h"
#include "dismantle/part_set.h"
#include "straight_paths.h"

namespace dismantle {
namespace {

/// The path as seen from where its parts stand now.
Path carried(const Path& path, const Pose& then, const Pose& now) {
  const Pose shift = now * then.inverse();
  Path out = path;
  for (auto& poses : out)
    for (Pose& pose : poses) pose = shift * pose;
  return out;
}

}  // namespace

Disassembly edited(const Plan& plan, const Assembly& assembly, const PlanEdit& edit) {
  const Disassembly before = disassembly_of(plan, assembly);
  std::vector<std::size_t> order = edit.order;
  if (order.empty()) {
    order.resize(before.steps().size());
    std::iota(order.begin(), order.end(), 0);
  }
  StraightPaths straight(assembly);
  Disassembly now(assembly.parts.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    DisassemblyStep step = before.steps().at(order[k]);
    const std::optional<std::size_t> group = now.common_group(step.parts);
    if (!group) throw StepRefused(assembly.source, k, "its parts are not together at that time");
    const std::vector<PlacedPart> moving = now.placed(step.parts);
    const std::vector<PlacedPart> rest = now.placed(without(now.groups()[*group], step.parts));
    const Pose then = before.pose(step.parts.front(), order[k]);
    if (const auto direction = edit.directions.find(order[k]); direction != edit.directions.end()) {
      if (step.placement)
        throw StepRefused(assembly.source, k, "a direction is for parts that leave, and these stay in their group");
      step.path = std::make_shared<const Path>(straight.path(moving, rest, direction->second));
      step.released.reset();
      step.forced.reset();
      step.depth = 0;
      step.planner = "edit";
    } else {
      Path path = same_place(then, moving.front().pose) ? *step.path : carried(*step.path, then, moving.front().pose);
      if (!step.placement && !step.released) path = straight.long_enough(std::move(path), step.parts, rest);
      step.path = std::make_shared<const Path>(std::move(path));
    }
    std::erase_if(step.contacts, [&](PartId part) { return now.group(part) != *group; });
    try {
      now.add(std::move(step));
    } catch (const std::logic_error& e) {
      throw StepRefused(assembly.source, k, e.what());
    }
  }
  return now;
}

}  // namespace dismantle
