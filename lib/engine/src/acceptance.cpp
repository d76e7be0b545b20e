#include "acceptance.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/part_set.h"

namespace dismantle {

namespace {

const AcceptedForce* accepted_pair(const MotionDepth& deepest, const Constraints& constraints) {
  const auto of_pair = [&](const AcceptedForce& a) {
    return (a.part == deepest.part && a.against == deepest.other) ||
           (a.part == deepest.other && a.against == deepest.part);
  };
  const auto found = std::find_if(constraints.accept.begin(), constraints.accept.end(), of_pair);
  return found == constraints.accept.end() ? nullptr : &*found;
}

/// Is step `index` valid for all pairs but the deepest one?
bool others_are_clear(const Disassembly& disassembly, std::size_t index, const Verifier& verifier,
                      RunContext& context) {
  const DisassemblyStep& step = disassembly.steps()[index];
  std::vector<PlacedPart> fixed;
  for (PartId id = 0; id < disassembly.parts(); ++id) {
    const bool there = disassembly.group(id, index) == disassembly.left_group(index);
    if (there && id != step.forced->deepest.other && !contains(step.parts, id))
      fixed.push_back({id, disassembly.pose(id, index)});
  }
  return verifier.check_motion(step.parts, fixed, *step.path, context).valid;
}

}  // namespace

void mark_accepted(Plan& plan, const Disassembly& disassembly, const Assembly& assembly, const Constraints& constraints,
                   const Verifier& verifier, RunContext& context) {
  bool all = true;
  for (std::size_t i = 0; i < disassembly.steps().size(); ++i) {
    const std::optional<ForcedCut>& cut = disassembly.steps()[i].forced;
    if (!cut) continue;
    const AcceptedForce* accepted = accepted_pair(cut->deepest, constraints);
    PlanForced& written = *plan.disassembly[i].forced;
    std::string why_not;
    if (accepted == nullptr)
      why_not = "no acceptance names this pair";
    else if (cut->lower_bound || cut->deepest.depth > accepted->depth)
      why_not = fmt::format("accepted are {:.4g}", accepted->depth / assembly.normalization.scale);
    else if (!others_are_clear(disassembly, i, verifier, context))
      why_not = "the step cuts into other parts, too";
    if (why_not.empty()) {
      written.accepted = accepted->as;
      continue;
    }
    all = false;
    if (!constraints.accept.empty())
      context.log(LogLevel::warning,
                  fmt::format("constraints.accept: step {} is not accepted, where '{}' cuts {:.4g} into '{}': {}", i + 1,
                              written.part, written.depth, written.other, why_not));
  }
  if (all && plan.status == PlanStatus::forced) plan.status = PlanStatus::complete;
  for (std::size_t i = 0; i < plan.assembly_steps.size(); ++i)
    plan.assembly_steps[i].forced = plan.disassembly[plan.disassembly.size() - 1 - i].forced;
}

}  // namespace dismantle
