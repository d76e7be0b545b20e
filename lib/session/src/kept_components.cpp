#include "kept_components.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

using Level = ComponentChoice::Level;

bool contains(const std::vector<PartId>& parts, PartId part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

/// Do the constraints say something different about the bodies of one component?
bool ordered_within(const Component& component, const Constraints& constraints) {
  return std::ranges::any_of(constraints.before, [&](const auto& rule) {
    return contains(component.parts, rule.first) && contains(component.parts, rule.second);
  });
}

bool taken_apart(const Component& component, const Disassembly& earlier) {
  return std::ranges::any_of(earlier.steps(), [&](const DisassemblyStep& step) {
    const auto moved = std::ranges::count_if(component.parts, [&](PartId p) { return contains(step.parts, p); });
    return (moved > 0 && static_cast<std::size_t>(moved) < component.parts.size()) ||
           (step.released && contains(component.parts, *step.released));
  });
}

void open(Component& component, std::string reason) {
  component.kept = false;
  component.reason = std::move(reason);
}

/// Why it is not out as a whole; empty: it is, or it stays for another reason.
std::string trouble(const std::vector<std::string>& names, const Plan& plan) {
  const auto within = [&](const std::string& part) { return std::ranges::count(names, part) > 0; };
  for (const PlanStep& step : plan.disassembly)
    if (step.forced && step.forced->accepted.empty() && within(step.moves.front().part))
      return step.forced->reason.empty() ? fmt::format("'{}' cuts into '{}'", step.forced->part, step.forced->other)
                                         : step.forced->reason;
  for (const PlanUnsolved& u : plan.unsolved)
    if (within(u.part)) {
      std::string out = u.message.empty() ? std::string(to_string(u.outcome)) : u.message;
      for (std::size_t i = 0; i < u.blocked_by.size(); ++i)
        out += fmt::format("{}'{}'", i == 0 ? ", blocked by " : ", ", u.blocked_by[i]);
      return out;
    }
  return {};
}

}  // namespace

std::vector<Component> kept_components(const Assembly& assembly, const RunConfig& config, bool keeps,
                                       const Disassembly* earlier) {
  const ComponentChoice& choice = config.components;
  check_component_names(config, product_names(assembly), assembly.source);
  const bool asked = (choice.level && *choice.level != Level::solid) || !choice.together.empty();
  if (asked && !keeps)
    throw Error(fmt::format("components are to be kept together, and sequence planner '{}' does not keep parts "
                            "together; set components.level: solid, or take another one",
                            config.sequence_planner.type));
  std::vector<Component> components = components_of(assembly, choice);
  const Constraints constraints = constraints_of(config.constraints, assembly);
  for (Component& c : components) {
    if (!c.kept) continue;
    if (!keeps)
      open(c, fmt::format("the sequence planner '{}' does not keep parts together", config.sequence_planner.type));
    else if (ordered_within(c, constraints))
      open(c, "constraints.before orders its bodies");
    else if (earlier != nullptr && taken_apart(c, *earlier))
      open(c, "the plan to go on from takes it apart");
  }
  return components;
}

void keep_together(const std::vector<Component>& components, Constraints& constraints) {
  for (const Component& c : components)
    if (c.kept) constraints.together.push_back(c.parts);
}

std::vector<PlanComponent> plan_components(const std::vector<Component>& components, const Plan& plan) {
  std::vector<PlanComponent> out;
  for (const Component& c : components) {
    PlanComponent written{c.name, c.product, {}, c.kept, c.reason};
    for (const PartId id : c.parts) written.parts.push_back(plan.assembly.parts.at(id).name);
    if (const std::string why = c.kept ? trouble(written.parts, plan) : ""; !why.empty())
      written.reason += "; it did not come out whole: " + why;
    out.push_back(std::move(written));
  }
  return out;
}

}  // namespace dismantle
