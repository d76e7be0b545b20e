#include "dismantle/plan_io/plan_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {
namespace {

using Lines = std::vector<std::string>;

template <class Range, class Condition>
std::size_t count_of(const Range& range, Condition condition) {
  return static_cast<std::size_t>(std::ranges::count_if(range, condition));
}

/// The steps: paths, forced ones, ways from the layout, proofs.
void tell_steps(const Plan& plan, PlanAccount& out) {
  const std::size_t forced = plan.forced_steps(), accepted = accepted_steps(plan);
  const double scale = plan.assembly.scale > 0 ? plan.assembly.scale : 1;
  if (const std::size_t n = plan.disassembly.size() - forced; n > 0)
    out.checked.push_back(
        fmt::format("the motion of {} at every instant, on the original triangles: parts cut in by at most {}",
                    text::counted(n, "step"), length_text(plan, plan.verified_max_penetration / scale)));
  if (accepted > 0)
    out.assumed.push_back(fmt::format("{} may cut in as deep as you accept", text::counted(accepted, "step")));
  if (forced > accepted)
    out.not_checked.push_back(
        fmt::format("the motion of {}: forced, no path is known", text::counted(forced - accepted, "step")));
  if (!plan.assembly_steps.empty() && plan.assembly_status != AssemblyStatus::reversed)
    out.checked.push_back(
        fmt::format("the way of {} from the layout", text::counted(plan.assembly_steps.size(), "step")));
  if (plan.assembly_status == AssemblyStatus::partial)
    out.not_checked.push_back("from the layout: " + plan.assembly_message);
  if (plan.assembly_status == AssemblyStatus::reversed && !plan.disassembly.empty())
    out.not_checked.push_back("how parts are brought to the assembly: it is the disassembly backwards");
  if (!plan.certificates.empty())
    out.checked.push_back(
        fmt::format("{} that parts cannot be separated", text::counted(plan.certificates.size(), "proof")));
  if (!plan.remaining.empty() && !plan.succeeded())
    out.not_checked.push_back(
        fmt::format("how {} come apart: they are left", text::counted(plan.remaining.size(), "part")));
  for (const PlanExcluded& excluded : plan.assembly.excluded)
    out.not_checked.push_back(fmt::format("{}, which is left out: {}", excluded.name, excluded.reason));
}

/// Of one check: how many steps it judged, its cost, what it refused, what it says of the plan as a whole.
void tell_check(const Plan& plan, const PlanObjectiveItem& item, PlanAccount& out) {
  std::size_t judged = 0, refused = 0;
  std::string failure;
  for (const PlanStep& step : plan.disassembly)
    for (const PlanVerdict& verdict : step.checks) {
      if (verdict.type != item.type) continue;
      if (!verdict.failed.empty()) {
        if (failure.empty()) failure = verdict.failed;
        continue;
      }
      ++judged;
      refused += !verdict.allowed;
    }
  if (judged > 0)
    out.checked.push_back(
        fmt::format("{}: {}, cost {:.4g}{}", item.type, text::counted(judged, "step"), item.cost,
                    refused > 0 ? fmt::format(", {} not allowed", text::counted(refused, "step")) : ""));
  if (!failure.empty())
    out.not_checked.push_back(
        fmt::format("{} of {}: {}", item.type, text::counted(plan.disassembly.size() - judged, "step"), failure));
  if (item.plan && !item.plan->failed.empty())
    out.not_checked.push_back(fmt::format("{} of the plan as a whole: {}", item.type, item.plan->failed));
  else if (item.plan) {
    if (!item.plan->reason.empty()) out.checked.push_back(fmt::format("{}: {}", item.type, item.plan->reason));
    for (const StepNote& note : item.plan->notes) out.checked.push_back(fmt::format("{}: {}", item.type, note.text));
  }
  std::string parameters;
  for (const auto& [name, value] : item.parameters)
    if (const std::string said = to_text(value); !said.empty())
      parameters += fmt::format("{}{} {}", parameters.empty() ? "" : ", ", name, said);
  if (!parameters.empty()) out.assumed.push_back(fmt::format("{}: {}", item.type, parameters));
}

/// What no check of the objective looks at.
void tell_gaps(const Plan& plan, PlanAccount& out) {
  const auto has = [&](std::initializer_list<const char*> types) {
    return std::ranges::any_of(plan.objective.checks, [&](const PlanObjectiveItem& item) {
      return std::ranges::any_of(types, [&](const char* type) { return item.type == type; });
    });
  };
  if (plan.disassembly.empty()) return;
  if (!has({"gravity", "support"})) out.not_checked.push_back("whether what is built stands, and what must be held");
  if (!has({"tool_access"})) out.not_checked.push_back("whether tools reach their fasteners");
}

void tell_parts(const Plan& plan, PlanAccount& out) {
  const PlanAssembly& a = plan.assembly;
  const std::size_t flexible = count_of(a.parts, [](const PlanPart& p) { return p.flexible.has_value(); });
  out.assumed.push_back(flexible == 0
                            ? std::string("parts are rigid")
                            : fmt::format("parts are rigid, but for {}", text::counted(flexible, "flexible part")));
  if (const std::size_t deep = count_of(a.overlaps, [](const PlanOverlap& o) { return o.depth > 0; }); deep > 0)
    out.assumed.push_back(fmt::format("{} that overlap when assembled may do so on the way, as deep as then",
                                      text::counted(deep, "pair")));
  if (const std::size_t open = count_of(a.parts, [](const PlanPart& p) { return p.open; }); open > 0)
    out.assumed.push_back(fmt::format("{} without a closed surface: a wall each", text::counted(open, "part")));
  if (const std::size_t kept = count_of(a.components, [](const PlanComponent& c) { return c.kept; }); kept > 0)
    out.assumed.push_back(fmt::format("{} of several bodies: one unit each", text::counted(kept, "product")));
  const InputFrame frame = input_frame(plan);
  if (!frame.unit_known) {
    const auto has_size = [](const PlanPart& p) { return p.kind && !p.kind->size.empty(); };
    out.assumed.push_back(count_of(a.parts, has_size) > 0
                              ? "the files name no unit: sizes of fasteners, and tools, are for mm"
                              : "the files name no unit");
  }
  out.assumed.push_back(fmt::format("drawn with {} up", axis_text(frame.up)));
}

}  // namespace

PlanAccount account_of(const Plan& plan) {
  PlanAccount out;
  tell_steps(plan, out);
  for (const PlanObjectiveItem& item : plan.objective.checks) tell_check(plan, item, out);
  tell_gaps(plan, out);
  tell_parts(plan, out);
  return out;
}

}  // namespace dismantle
