#include "replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/engine/broken_constraint.h"
#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/part_set.h"

namespace dismantle {

StepRefused::StepRefused(std::string subject, std::size_t step, std::string reason)
    : InputError(std::move(subject),
                 fmt::format("step {} of the plan to go on from is not valid here: {}", step + 1, reason)),
      step_(step),
      reason_(std::move(reason)) {}

StepRefused::~StepRefused() = default;

namespace {

/// Passes a removal on with the planner and the reason that the earlier step states.
const AttemptResult& ask_again(const DisassemblyStep& step, const Attempt& question, Oracle& oracle,
                               const Assembly& assembly, std::size_t number, RunContext& context) {
  if (!step.forced) return oracle.propose(question, *step.path, context);
  if (oracle.forcing() == nullptr)
    throw InputError(assembly.source, fmt::format("step {} of the plan is forced, and 'run.force' is off", number));
  std::vector<Unsolved> said;
  for (const PartId id : step.parts) said.push_back({id, Outcome::exhausted, {}, {}, step.forced->reason});
  return oracle.forcing()->propose_forced(question, *step.path, std::nullopt, said, context);
}

}  // namespace

void replay(const Disassembly& earlier, const Assembly& assembly, const Constraints& constraints, Oracle& oracle,
            Recorder& recorder, RunContext& context) {
  for (std::size_t k = 0; k < earlier.steps().size() && !context.should_stop(); ++k) {
    const DisassemblyStep& step = earlier.steps()[k];
    const Disassembly& now = recorder.disassembly();
    const std::optional<std::size_t> group = now.common_group(step.parts);
    if (!group) throw StepRefused(assembly.source, k, "it moves parts that are not together");
    if (const std::string broken = broken_constraint(step, now.groups()[*group], constraints); !broken.empty())
      throw StepRefused(assembly.source, k, broken);
    Attempt question{now.placed(step.parts), now.placed(without(now.groups()[*group], step.parts))};
    question.goal.placement = step.placement;
    if (step.released) question.goal.any_of = {*step.released};
    const AttemptResult& answer = ask_again(step, question, oracle, assembly, k + 1, context);
    if (!answer.removes()) {
      if (context.should_stop()) return;
      throw StepRefused(assembly.source, k, answer.result.message);
    }
    recorder.repeated({step.parts, &answer, "", step.up}, step);
  }
}

DisassemblyStep disassembly_step(const PlanStep& from, const Assembly& assembly) {
  const auto fail = [&](const std::string& why) {
    throw InputError(assembly.source, fmt::format("step {} of the plan {}", from.step, why));
  };
  std::vector<std::pair<PartId, const PlanMove*>> moves;
  for (const PlanMove& move : from.moves) {
    const auto part =
        std::find_if(assembly.parts.begin(), assembly.parts.end(), [&](const Part& p) { return p.name == move.part; });
    if (part == assembly.parts.end()) fail(fmt::format("moves '{}', which the assembly does not have", move.part));
    moves.emplace_back(part->id, &move);
  }
  std::sort(moves.begin(), moves.end());
  DisassemblyStep step;
  Path path(moves.empty() ? 0 : moves.front().second->poses.size());
  for (const auto& [id, move] : moves) {
    step.parts.push_back(id);
    if (move->poses.size() != path.size() || path.size() < 2) fail("has moves of different lengths");
    for (std::size_t i = 0; i < path.size(); ++i)
      path[i].push_back(assembly.normalization.pose_to_internal(move->poses[i]));
  }
  step.path = std::make_shared<const Path>(std::move(path));
  step.placement = from.separates.empty();
  if (!step.placement && from.separates.front().size() == 1 && moves.size() > 1)
    for (const auto& [id, move] : moves)
      if (move->part == from.separates.front().front()) step.released = id;
  step.max_penetration = from.max_penetration;
  step.seconds = from.seconds;
  step.depth = from.depth;
  step.planner = from.planner;
  step.up = from.up;
  for (const std::string& name : from.contacts)
    if (const auto part =
            std::find_if(assembly.parts.begin(), assembly.parts.end(), [&](const Part& p) { return p.name == name; });
        part != assembly.parts.end())
      step.contacts.push_back(part->id);
  if (from.forced) step.forced = ForcedCut{{}, from.forced->lower_bound, from.forced->reason, {}};
  return step;
}

Disassembly disassembly_of(const Plan& plan, const Assembly& assembly, std::size_t count) {
  Disassembly done(assembly.parts.size());
  for (std::size_t k = 0; k < std::min(count, plan.disassembly.size()); ++k) {
    const PlanStep& from = plan.disassembly[k];
    try {
      done.add(disassembly_step(from, assembly));
    } catch (const std::logic_error& e) {
      throw InputError(assembly.source, fmt::format("step {} of the plan is not possible after those before it: {}",
                                                    from.step, e.what()));
    }
  }
  return done;
}

}  // namespace dismantle
