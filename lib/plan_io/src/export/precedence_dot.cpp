// precedence.dot: what had to leave before what.
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/plan_history.h"
#include "export/dot_text.h"

namespace dismantle {
std::string to_dot(const Plan& plan, const std::vector<std::pair<std::string, std::string>>& precedence) {
  const PlanHistory history(plan);
  std::map<std::string, unsigned> left_in;
  for (std::size_t s = 0; s < history.steps(); ++s)
    for (const std::size_t i : history.leaving(s))
      left_in.emplace(plan.assembly.parts[i].name, plan.disassembly[s].step);

  std::string out =
      "// a -> b: a left before b, and got in b's way while it was there.\n"
      "digraph precedence {\n"
      "  rankdir=LR;\n"
      "  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n";
  std::set<std::string> forced;
  for (const PlanStep& step : plan.disassembly)
    if (step.forced && step.forced->accepted.empty())
      for (const PlanMove& move : step.moves) forced.insert(move.part);
  for (const PlanPart& part : plan.assembly.parts) {
    const auto step = left_in.find(part.name);
    const bool leaves = step != left_in.end();
    const std::string label = leaves ? fmt::format("{}. {}", step->second, part.name) : part.name;
    out += fmt::format("  {} [label={}{}];\n", dot_quoted(part.name), dot_quoted(label),
                       forced.contains(part.name) ? ", color=red, fontcolor=red"
                       : leaves                   ? ""
                                                  : ", style=\"rounded,filled\"");
  }
  for (const auto& [before, after] : precedence)
    out += fmt::format("  {} -> {};\n", dot_quoted(before), dot_quoted(after));
  return out + "}\n";
}

}  // namespace dismantle
