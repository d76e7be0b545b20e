#include "dismantle/plan_io/order_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "dismantle/plan_io/step_numbers.h"

namespace dismantle {
namespace {

constexpr std::size_t kListed = 20;  // steps of the longest list that somebody reads

/// "step 3", "steps 2, 5–9 and 12".
std::string steps_words(const std::set<std::size_t>& numbers) {
  std::vector<std::string> said;
  for (auto at = numbers.begin(); at != numbers.end();) {
    const std::size_t first = *at;
    std::size_t last = first;
    while (++at != numbers.end() && *at == last + 1) last = *at;
    if (last > first + 1) {
      said.push_back(fmt::format("{}–{}", first, last));
    } else {
      said.push_back(std::to_string(first));
      if (last > first) said.push_back(std::to_string(last));
    }
  }
  std::string out = numbers.size() == 1 ? "step " : "steps ";
  for (std::size_t k = 0; k < said.size(); ++k) out += (k == 0 ? "" : k + 1 == said.size() ? " and " : ", ") + said[k];
  return out;
}

double weighted(const PlanObjectiveItem& item) { return item.weight * item.cost; }

/// Of the check `type`, its cost times its weight; 0 if there is none.
double cost_of(const PlanObjective& objective, const std::string& type) {
  double sum = 0;
  for (const PlanObjectiveItem& item : objective.checks)
    if (item.type == type) sum += weighted(item);
  return sum;
}

}  // namespace

std::string order_words(const Plan& plan, std::size_t index, bool disassembly) {
  const PlanStep& step = plan.disassembly.at(index);
  if (step.layer == 0) return {};        // not determined
  std::set<std::size_t> earlier, later;  // in the disassembly
  for (const unsigned s : step.after) earlier.insert(step_number(plan, s - 1, disassembly));
  for (std::size_t k = 0; k < plan.disassembly.size(); ++k)
    if (std::ranges::find(plan.disassembly[k].after, step.step) != plan.disassembly[k].after.end())
      later.insert(step_number(plan, k, disassembly));
  if (!disassembly) std::swap(earlier, later);
  if (earlier.empty() && later.empty()) return "at any place: no other step has to come before or after it";
  std::string out;
  if (!earlier.empty()) out += "after " + steps_words(earlier);
  if (!later.empty()) out += (out.empty() ? "before " : ", before ") + steps_words(later);
  return out + ": parts are in the way otherwise";
}

std::vector<std::string> cost_words(const Plan& plan, bool disassembly) {
  const PlanObjective& objective = plan.objective;
  if (objective.empty()) return {"no check judged the order: it is one of those that are free of collisions"};
  std::vector<std::string> out;
  for (const PlanObjectiveItem& item : objective.checks) {
    std::set<std::size_t> where;
    for (std::size_t s = 0; s < plan.disassembly.size(); ++s)
      for (const PlanVerdict& verdict : plan.disassembly[s].checks)
        if (verdict.type == item.type && verdict.cost > 0) where.insert(step_number(plan, s, disassembly));
    if (weighted(item) <= 0) continue;
    const std::string steps = where.size() > kListed ? fmt::format("{} steps", where.size()) : steps_words(where);
    out.push_back(fmt::format("{}: costs {:.3g} of {:.3g}{}", item.type, weighted(item), objective.cost,
                              where.empty() ? " for the plan as a whole" : ", in " + steps));
  }
  if (out.empty()) out.push_back("no check finds a fault with this order: it costs nothing");
  if (objective.cost > 0 && !objective.least_cost)
    out.push_back("that no other order costs less is not proved");
  else if (objective.cost > 0 && *objective.least_cost >= objective.cost - 1e-6 * double(plan.assembly.parts.size()))
    out.push_back("no order of these motions costs less");
  else if (objective.cost > 0)
    out.push_back(fmt::format("no order of these motions costs less than {:.3g}", *objective.least_cost));
  return out;
}

std::string cost_change_words(const PlanObjective& before, const PlanObjective& now) {
  if (before.empty() && now.empty()) return {};
  std::string out = fmt::format("it costs {:.3g} (before: {:.3g})", now.cost, before.cost), changed;
  for (const PlanObjectiveItem& item : now.checks) {
    const double was = cost_of(before, item.type), is = weighted(item);
    if (is != was) changed += fmt::format("{}{} {:.3g} ({:.3g})", changed.empty() ? ": " : ", ", item.type, is, was);
  }
  return out + changed;
}

}  // namespace dismantle
