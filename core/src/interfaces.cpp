// Key functions of the interfaces: their type information lives here once, so that a plugin's object is
// recognised across shared libraries.
#include <algorithm>
#include <stdexcept>

#include "dismantle/importer.h"
#include "dismantle/path_oracle.h"
#include "dismantle/sequence_planner.h"
#include "dismantle/simulator.h"
#include "dismantle/step_check.h"
#include "dismantle/transfer_planner.h"

namespace dismantle {

World::~World() = default;
bool World::body_separated(const State& state, std::size_t body) {
  if (scene().moving.size() != 1 || body != 0)
    throw std::logic_error("a simulator that moves several parts simultaneously has to override World::body_separated");
  return separated(state);
}
PreparedAssembly::~PreparedAssembly() = default;
Simulator::~Simulator() = default;

PathOracle::~PathOracle() = default;
const Certificate* PathOracle::prove(const SeparationQuestion& /*question*/, const RunContext& /*context*/) {
  return nullptr;
}
std::optional<std::vector<PartId>> PathOracle::obstacles(const Attempt& attempt, const Path& path,
                                                         RunContext& context) {
  Attempt rest = attempt;
  std::vector<PartId> found;
  for (;;) {
    const AttemptResult& answer = propose(rest, path, context);
    if (is_success(answer.result.outcome())) break;
    const std::vector<PartId>& blocked_by = answer.result.blocked_by;
    const std::size_t before = rest.fixed.size();
    std::erase_if(rest.fixed, [&](const PlacedPart& p) {
      return std::find(blocked_by.begin(), blocked_by.end(), p.part) != blocked_by.end();
    });
    if (rest.fixed.size() == before || context.should_stop()) return std::nullopt;
    found.insert(found.end(), blocked_by.begin(), blocked_by.end());
  }
  std::sort(found.begin(), found.end());
  return found;
}
ForcingOracle::~ForcingOracle() = default;
TransferPlanner::~TransferPlanner() = default;
SequenceObserver::~SequenceObserver() = default;
bool SequenceObserver::taken_back(std::size_t /*count*/) { return false; }
SequencePlanner::~SequencePlanner() = default;
StepCheck::~StepCheck() = default;
StepVerdict StepCheck::judge_plan(std::span<const StepQuestion> /*operations*/, const RunContext& /*context*/) const {
  return {};
}

DisassemblyStep step_of(const Removal& removal) {
  const AttemptResult& answer = *removal.attempt;
  DisassemblyStep step;
  step.parts = removal.parts;
  step.path = std::make_shared<const Path>(answer.path());
  step.placement = answer.attempt.goal.placement;
  step.released = answer.out;
  step.up = removal.up;
  return step;
}

std::vector<std::vector<PlacedPart>> whole_assembly(const Assembly& assembly) {
  std::vector<PlacedPart> all;
  for (const Part& part : assembly.parts) all.push_back({part.id, Pose{}});
  return {all};
}
Importer::~Importer() = default;

}  // namespace dismantle
