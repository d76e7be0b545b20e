#include "dismantle/plan_io/verdicts.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {

const std::vector<PlanVerdict>& checks_of_assembly_step(const Plan& plan, const PlanStep& step) {
  static const std::vector<PlanVerdict> none;
  const std::size_t n = plan.disassembly.size();
  return step.step >= 1 && step.step <= n ? plan.disassembly[n - step.step].checks : none;
}

std::vector<std::string> cost_lines(const std::vector<PlanVerdict>& checks) {
  std::vector<std::string> lines;
  for (const PlanVerdict& v : checks) {
    const std::string why = v.reason.empty() ? "" : ": " + v.reason;
    if (!v.failed.empty()) lines.push_back(fmt::format("{}: not judged: {}", v.type, v.failed));
    if (!v.allowed)
      lines.push_back(fmt::format("{}: not allowed{}", v.type, why));
    else if (v.cost > 0)
      lines.push_back(fmt::format("{}: cost {:.4g}{}", v.type, v.cost, why));
  }
  return lines;
}

std::string objective_text(const Plan& plan) {
  const PlanObjective& objective = plan.objective;
  if (objective.empty()) return "";
  std::string out = fmt::format("objective: {:.4g} in all", objective.cost);
  if (const auto& least = objective.least_cost)
    out += *least < objective.cost ? fmt::format(" (no order of these motions costs less than {:.4g})", *least)
                                   : std::string(" (no order of these motions costs less)");
  for (const PlanObjectiveItem& item : objective.checks)
    out += fmt::format("; {}: {:.4g}, weight {:.4g}", item.type, item.cost, item.weight);
  if (const std::string first = first_order_words(objective); !first.empty()) out += "; " + first;
  const auto count = [&](auto which) {
    return static_cast<std::size_t>(std::ranges::count_if(
        plan.disassembly, [&](const PlanStep& step) { return std::ranges::any_of(step.checks, which); }));
  };
  if (const std::size_t n = count([](const PlanVerdict& v) { return !v.allowed; }); n > 0)
    out += fmt::format("; {} not allowed", text::counted(n, "step"));
  if (const std::size_t n = count([](const PlanVerdict& v) { return !v.failed.empty(); }); n > 0)
    out += fmt::format("; {} not judged", text::counted(n, "step"));
  return out;
}

}  // namespace dismantle
