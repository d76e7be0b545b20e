#include "dismantle/plan_io/order_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

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

namespace {

/// "2 more", "0.5 less"; empty: no difference worth a word.
std::string more_words(double cost, double than) {
  if (std::abs(cost - than) < 1e-6 * (1 + than)) return {};
  return fmt::format("{:.3g} {}", std::abs(cost - than), cost > than ? "more" : "less");
}

/// What each check says otherwise than of the plan: "directions 3 more, gravity 1 less".
std::string changes_words(const PlanObjective& objective, const PlanAlternative& other) {
  std::string out;
  for (std::size_t i = 0; i < std::min(other.checks.size(), objective.checks.size()); ++i) {
    const PlanVerdict& v = other.checks[i];
    const std::string more = more_words(v.weight * v.cost, weighted(objective.checks[i]));
    if (more.empty()) continue;
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", v.type, more);
    if (!v.allowed) out += ", not allowed";
    if (!v.reason.empty()) out += fmt::format(" ({})", v.reason);
  }
  return out;
}

/// What has to come before and after a step.
std::string waits_words(const Plan& plan, std::size_t index, bool disassembly) {
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

}  // namespace

double cost_of(const PlanAlternative& other) {
  double sum = 0;
  for (const PlanVerdict& v : other.checks) sum += v.weight * v.cost;
  return sum;
}

std::string other_place_words(const Plan& plan, std::size_t index, bool disassembly) {
  std::string out;
  for (const PlanAlternative& other : plan.objective.alternatives) {
    if (other.step != index + 1) continue;
    const bool earlier = (other.place < other.step) == disassembly;
    const std::string more = more_words(cost_of(other), plan.objective.cost);
    const std::string why = changes_words(plan.objective, other);
    out += fmt::format("{}{} step {} it would cost {}{}", out.empty() ? "" : "; ", earlier ? "before" : "after",
                       step_number(plan, other.place - 1, disassembly), more.empty() ? "as much" : more,
                       why.empty() ? "" : ": " + why);
  }
  return out;
}

std::string order_words(const Plan& plan, std::size_t index, bool disassembly) {
  const std::string waits = waits_words(plan, index, disassembly), other = other_place_words(plan, index, disassembly);
  return waits.empty() || other.empty() ? waits + other : waits + "; " + other;
}

std::string first_order_words(const PlanObjective& objective) {
  for (const PlanAlternative& other : objective.alternatives)
    if (other.step == 0) {
      const std::string why = changes_words(objective, other);
      return fmt::format("the order that was found first would cost {:.3g}{}", cost_of(other),
                         why.empty() ? "" : ": " + why);
    }
  return {};
}

std::vector<std::string> cost_words(const Plan& plan, bool disassembly) {
  const PlanObjective& objective = plan.objective;
  const auto decides = [](const PlanObjectiveItem& item) { return item.weight > 0 || item.require; };
  if (std::ranges::none_of(objective.checks, decides))
    return {"no check judged the order: it is one of those that are free of collisions"};
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
    out.push_back(fmt::format("no order of these motions costs less than {:.3g}: the gap is {:.0f} %",
                              *objective.least_cost, 100 * (1 - *objective.least_cost / objective.cost)));
  if (std::string first = first_order_words(objective); !first.empty()) out.push_back(std::move(first));
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
