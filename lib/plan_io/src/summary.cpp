#include "dismantle/plan_io/summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/thread_words.h"
#include "dismantle/plan_io/verdicts.h"

namespace dismantle {
namespace {

/// "open: a, b and 3 more parts: their surfaces are not closed, and are walls".
std::string open_text(const std::vector<PlanPart>& parts) {
  std::string names;
  std::size_t count = 0;
  for (const PlanPart& part : parts)
    if (part.open && ++count <= 5) names += fmt::format("{}{}", names.empty() ? "" : ", ", part.name);
  if (count == 0) return {};
  if (count > 5) names += fmt::format(" and {} more", count - 5);
  return fmt::format("open: {}: {} not closed, and {}\n", names, count == 1 ? "its surface is" : "their surfaces are",
                     count == 1 ? "is a wall" : "are walls");
}

std::string excluded_text(const std::vector<PlanExcluded>& excluded) {
  std::string out;
  for (const PlanExcluded& e : excluded) out += fmt::format("left out: {}: {}\n", e.name, e.reason);
  return out;
}

/// The motion of a step in words, as a line; "and stays" if it separates nothing.
std::string moves_text(const Plan& plan, const InputFrame& frame, TextUnit unit, const PlanStep& step) {
  if (step.moves.empty()) return {};
  const Aabb& box = plan.assembly.box;
  if (!frame.unit_known) unit.name = "units";
  const double size = box.empty() ? 1 : std::max(box.size().maxCoeff(), 1e-300);
  const Eigen::Vector3d middle = box.empty() ? plan.assembly.center : box.center();
  const MotionSummary motion = summarize_motion(step.moves.front().poses, middle, stretch_tolerance(size));
  return fmt::format("       {}{}\n",
                     motion_words(in_unit(motion, unit.factor), unit.name, frame.up, frame.lies(step.up)),
                     step.separates.empty() ? ", and stays there" : "");
}

std::string asked_text(const Plan& plan) {
  const PlanAsked& asked = plan.asked;
  if (!asked.part.empty()) return fmt::format("{} came out, which was all that was asked for", asked.part);
  if (!asked.target.empty()) return fmt::format("{} is out, which was the target", asked.target);
  return asked.together.empty() ? "every part came out" : "every part came out but for those that are to stay together";
}

std::string accepted_text(const Plan& plan) {
  const std::size_t accepted = accepted_steps(plan);
  return accepted == 0 ? "" : fmt::format(", {} with a cut that you accept", text::counted(accepted, "step"));
}

/// One line for all uses of a product that are read alike.
std::string components_text(const std::vector<PlanComponent>& components) {
  std::string out;
  for (auto c = components.begin(); c != components.end(); ++c) {
    const auto alike = [&](const PlanComponent& o) {
      return o.kept == c->kept && o.product == c->product && o.reason == c->reason;
    };
    if (std::any_of(components.begin(), c, alike)) continue;
    const auto uses = static_cast<std::size_t>(std::count_if(c, components.end(), alike));
    out += fmt::format("{}: {}{} ({}): {}\n", c->kept ? "one unit" : "single parts",
                       uses > 1 ? fmt::format("{}x ", uses) : "", c->product, fmt::format("{} bodies", c->parts.size()),
                       c->reason);
    if (c->kept) out += fmt::format("          --open \"{}\" plans its bodies one by one\n", c->product);
  }
  return out;
}

}  // namespace

std::size_t accepted_steps(const Plan& plan) {
  return static_cast<std::size_t>(std::ranges::count_if(
      plan.disassembly, [](const PlanStep& s) { return s.forced && !s.forced->accepted.empty(); }));
}

std::string result_word(const Plan& plan) {
  return std::string(to_string(plan.succeeded()                      ? PlanStatus::complete
                               : plan.status == PlanStatus::complete ? PlanStatus::partial
                                                                     : plan.status));
}

std::string result_text(const Plan& plan) {
  const std::string word = result_word(plan);
  switch (plan.status) {
    case PlanStatus::complete:
      return fmt::format("{}: {}{}{}", word, asked_text(plan), accepted_text(plan),
                         plan.succeeded() ? "" : ", and some parts of the input could not be used");
    case PlanStatus::forced:
      return fmt::format("{}: {}, in {} by force", word, asked_text(plan),
                         text::counted(plan.forced_steps() - accepted_steps(plan), "step")) +
             accepted_text(plan);
    case PlanStatus::partial:
      break;
  }
  const std::string& out = plan.asked.part.empty() ? plan.asked.target : plan.asked.part;
  return fmt::format("{}: {} left{}", word, text::counted(plan.remaining.size(), "part"),
                     out.empty() ? "" : fmt::format(", {} is not out", out));
}

std::string summary_text(const Plan& plan, bool details, TextUnit unit) {
  if (unit.name.empty()) unit = length_unit(plan);
  const auto& a = plan.assembly;
  double worst = 0;
  for (const auto& step : plan.disassembly) worst = std::max(worst, step.max_penetration);
  std::string out = fmt::format("{}: {}, {}, {}\n", a.source, text::counted(a.parts.size(), "part"),
                                text::counted(plan.disassembly.size(), "step"), result_text(plan));
  out += components_text(a.components);
  const std::size_t width = text::widest_step(plan);
  const double scale = a.scale > 0 ? a.scale : 1;  // people read input units
  const std::size_t forced = plan.forced_steps(), accepted = accepted_steps(plan);
  // In a puzzle, how far each piece goes is the solution; elsewhere parts just leave.
  const bool puzzle = std::any_of(plan.disassembly.begin(), plan.disassembly.end(),
                                  [](const PlanStep& step) { return step.separates.empty(); });
  const InputFrame frame = puzzle ? input_frame(plan) : InputFrame{};
  for (const auto& step : plan.disassembly) {
    std::string line = fmt::format("{:>5}  {}", step.step, text::padded(text::names_of(plan, step), width));
    if (details) line += fmt::format("  {:8.2f} s", step.seconds);
    if (step.forced) {
      out += fmt::format("{}  {}: {}\n", line, step.forced->accepted.empty() ? "FORCED" : "accepted",
                         forced_text(unit, *step.forced));
      continue;
    }
    if (details) line += fmt::format("  penetration <= {}", length_text(unit, step.max_penetration / scale));
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    if (puzzle) out += moves_text(plan, frame, unit, step);
    out += overlaps_text(unit, step);
    for (const std::string& words : thread_words(plan, step)) out += "       " + words + "\n";
  }
  if (forced > accepted)
    out += fmt::format("{} forced: no verified path was found, the parts are taken out where they cut in least\n",
                       text::counted(forced - accepted, "step"));
  if (plan.disassembly.size() > forced)
    out += fmt::format("every {}step is verified{}\n", forced > 0 ? "other " : "",
                       details ? fmt::format(": penetration <= {} of {} allowed", length_text(unit, worst / scale),
                                             length_text(unit, plan.verified_max_penetration / scale))
                               : "");
  if (!plan.objective.empty()) out += objective_text(plan) + "\n";
  if (plan.assembly_status == AssemblyStatus::complete)
    out += fmt::format("assembly: {} from the layout, verified the same way\n",
                       text::counted(plan.assembly_steps.size(), "step"));
  if (plan.assembly_status == AssemblyStatus::partial)
    out += fmt::format("assembly: partial: {}\n", plan.assembly_message);
  if (!plan.remaining.empty()) out += fmt::format("stays: {}\n", text::joined(plan.remaining));
  out += excluded_text(a.excluded);
  out += open_text(a.parts);
  for (const auto& u : plan.unsolved) {
    out += fmt::format("unsolved: {}: {}", u.part, to_string(u.outcome));
    if (!u.blocked_by.empty()) out += fmt::format(", blocked by {}", text::joined(u.blocked_by));
    if (!u.refused_by.empty()) out += fmt::format(", refused by the step check '{}'", u.refused_by);
    out += '\n';
  }
  return out;
}

}  // namespace dismantle
