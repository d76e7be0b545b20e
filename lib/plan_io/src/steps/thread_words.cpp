#include "dismantle/plan_io/thread_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/plan_io/explain.h"

namespace dismantle {

std::vector<std::string> thread_words(const Plan& plan, const PlanStep& step) {
  const auto is_screw = [&](const std::string& name) {
    const auto named = [&](const PlanPart& p) { return p.name == name && p.kind && p.kind->kind == "screw"; };
    return std::any_of(plan.assembly.parts.begin(), plan.assembly.parts.end(), named);
  };
  std::vector<std::string> out;
  for (const PlanStepOverlap& o : step.overlaps) {
    if (!(o.depth > 1.01 * o.assembled)) continue;
    const bool first = is_screw(o.part);
    if (!first && !is_screw(o.other)) continue;
    out.push_back(fmt::format("'{}' cuts its thread, {} deep, into '{}' ({} when assembled)", first ? o.part : o.other,
                              length_text(plan, o.depth), first ? o.other : o.part, length_text(plan, o.assembled)));
  }
  return out;
}

}  // namespace dismantle
