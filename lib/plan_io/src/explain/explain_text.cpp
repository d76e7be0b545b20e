#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {
namespace {

double size_of(const Plan& plan) { return plan.assembly.box.empty() ? 0 : plan.assembly.box.size().maxCoeff(); }

std::string place_text(const Eigen::Vector3d& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

/// How far the part came.
std::string travel_text(const Plan& plan, const TextUnit& unit, const LeftPart& part) {
  if (!part.moved) return "it did not move";
  std::string out = "came " + length_text(unit, part.travel);
  if (const double size = size_of(plan); size > 0)
    out += fmt::format(" ({:.1f} % of the assembly's largest edge)", 100 * part.travel / size);
  const double degrees = part.turn * 180 / std::numbers::pi;
  if (degrees > 0.05) out += fmt::format(", turned by {:.1f} degrees", degrees);
  return out;
}

std::string search_text(const LeftPart& part) {
  if (part.attempts == 0) return "no search on record";
  return fmt::format("{} {} by {}{}, {:.1f} s", part.attempts, part.attempts == 1 ? "search" : "searches", part.planner,
                     part.depth > 0 ? fmt::format(" to depth {}", part.depth) : "", part.seconds);
}

std::string blockers_text(const TextUnit& unit, const LeftPart& part) {
  const std::size_t shown = 6;  // what fits into a line or two
  std::string out;
  for (std::size_t i = 0; i < std::min(part.blockers.size(), shown); ++i) {
    const Blocker& b = part.blockers[i];
    out += (i == 0 ? "" : ", ") + b.part;
    if (b.at) out += " at " + place_text(*b.at);
    if (b.overlap > 0) out += fmt::format(" (overlaps it by {} when assembled)", length_text(unit, b.overlap));
  }
  if (part.blockers.size() > shown) out += fmt::format(" and {} more", part.blockers.size() - shown);
  return out;
}

std::string reason_text(const Plan& plan, const TextUnit& unit, const LeftReason& reason) {
  const bool one = reason.parts.size() == 1;
  std::string out = one ? fmt::format("\n{} did not come out", reason.parts.front().part)
                        : fmt::format("\n{} parts did not come out", reason.parts.size());
  out += fmt::format(": {} ({})\n", reason.meaning, to_string(reason.outcome));
  const std::string& first = reason.parts.front().message;
  const bool shared = std::ranges::all_of(reason.parts, [&](const LeftPart& p) { return p.message == first; });
  for (const LeftPart& part : reason.parts) {
    const std::string indent = one ? "  " : "    ";
    if (!one) out += fmt::format("  {}\n", part.part);
    out += fmt::format("{}tried: {}; {}\n", indent, search_text(part), travel_text(plan, unit, part));
    if (!part.blockers.empty()) out += fmt::format("{}blocked by: {}\n", indent, blockers_text(unit, part));
    if (!shared && !part.message.empty()) out += fmt::format("{}planner: {}\n", indent, part.message);
  }
  if (reason.certificate != nullptr) {
    const PlanCertificate& c = *reason.certificate;
    const double scale = plan.assembly.scale > 0 ? plan.assembly.scale : 1;
    out += fmt::format("  proof {} ({}), for {}; `dismantle verify` checks it again\n    {}\n",
                       reason.certificate_number, c.kind,
                       c.full_tolerance ? std::string("all motions within the tolerance")
                                        : "motions that cut in by no more than " + length_text(unit, c.margin / scale),
                       c.text);
  }
  if (shared && !first.empty() && (reason.certificate == nullptr || reason.certificate->text != first))
    out += fmt::format("  planner: {}\n", first);
  if (!reason.advice.empty()) out += "  what you can do:\n";
  for (const std::string& advice : reason.advice) out += fmt::format("  - {}\n", advice);
  return out;
}

/// "1 (washer), 3 (pin and nut)"
std::string earlier_text(const Explanation& e, const std::vector<unsigned>& steps) {
  std::string out;
  for (const unsigned step : steps) {
    const auto& all = e.plan->disassembly;
    out += fmt::format("{}{}", out.empty() ? "" : ", ", step);
    if (step >= 1 && step <= all.size()) out += fmt::format(" ({})", text::names_of(all[step - 1]));
  }
  return out;
}

/// What the step checks say of the step as an assembly operation.
std::string notes_text(const PlanStep& step) {
  std::string out;
  for (const PlanVerdict& verdict : step.checks)
    for (const StepNote& note : verdict.notes) out += fmt::format("{:>5}  put in: {}\n", "", note.text);
  return out;
}

std::string steps_text(const Explanation& e, const TextUnit& unit) {
  if (e.steps.empty()) return "";
  std::size_t width = 4;
  for (const StepReason& step : e.steps) width = text::column_of(width, text::joined(step.parts));
  std::string out = "\nwhy this order (numbers of the disassembly, in brackets those of the assembly):\n";
  const std::size_t digits = std::to_string(e.plan->disassembly.size()).size() + 2;
  for (const StepReason& step : e.steps) {
    const std::string in_assembly = fmt::format("({})", step_number(*e.plan, step.step - 1, false));
    out += fmt::format("{:>5} {:>{}}  {}  ", step.step, in_assembly, digits,
                       text::padded(text::joined(step.parts), width));
    const PlanStep& done = e.plan->disassembly.at(step.step - 1);
    if (done.forced) {
      out += fmt::format("FORCED: {}\n", forced_text(unit, *done.forced));
      if (const std::string reached = reached_text(*e.plan, unit, done); !reached.empty())
        out += fmt::format("{:>5}  how far: {}\n", "", reached);
      if (const std::string advice = forced_advice(*done.forced); !advice.empty())
        out += fmt::format("{:>5}  what you can do: {}\n", "", advice);
      if (!done.forced->reason.empty()) out += fmt::format("{:>5}  because: {}\n", "", done.forced->reason);
      if (done.forced->certificate)
        out += fmt::format("{:>5}  proof {} of the plan; `dismantle verify` checks it again\n", "",
                           *done.forced->certificate + 1);
      out += notes_text(done);
      continue;
    }
    if (!step.known)
      out += "the plan does not say what had to come first\n";
    else if (step.after.empty())
      out += "free from the beginning: it needed no other step\n";
    else
      out += fmt::format("needed {} {} first: what {} took out was in its path\n",
                         step.after.size() == 1 ? "step" : "steps", earlier_text(e, step.after),
                         step.after.size() == 1 ? "it" : "they");
    if (const std::string other = other_place_words(*e.plan, step.step - 1, true); !other.empty())
      out += fmt::format("{:>5}  {}\n", "", other);
    out += notes_text(done);
  }
  if (const std::string first = first_order_words(e.plan->objective); !first.empty())
    out += fmt::format("this order costs {:.3g}; {}\n", e.plan->objective.cost, first);
  return out;
}

/// What to lay ready.
std::string job_text(const Plan& plan) {
  const JobList job = job_list(plan);
  std::string out;
  if (!job.fasteners.empty()) out += "\nfasteners:\n";
  for (const JobFastener& f : job.fasteners) out += fmt::format("  {}\n", fastener_words(f));
  if (!job.tools.empty()) out += "\ntools (steps of the assembly):\n";
  for (const JobTool& t : job.tools) out += fmt::format("  {}\n", tool_words(t));
  return out;
}

}  // namespace

std::string explain_text(const Explanation& e) { return explain_text(e, length_unit(*e.plan)); }

std::string explain_text(const Explanation& e, const TextUnit& unit) {
  const Plan& plan = *e.plan;
  const PlanAssembly& a = plan.assembly;
  const bool complete = plan.status != PlanStatus::partial;
  std::string out = fmt::format("{}: {}, {} done, {}\n", a.source, text::counted(a.parts.size(), "part"),
                                text::counted(plan.disassembly.size(), "step"), result_text(plan));
  for (const PlanExcluded& part : a.excluded) out += fmt::format("left out: {}: {}\n", part.name, part.reason);
  for (const LeftReason& reason : e.left) out += reason_text(plan, unit, reason);
  if (!e.untried.empty())
    out += fmt::format("\nstill together, without a failed search on record: {}\n", text::joined(e.untried));
  out += steps_text(e, unit);
  if (!e.steps.empty() && e.steps.size() == plan.disassembly.size()) out += job_text(plan);
  if (e.left.empty() && e.steps.empty() && e.untried.empty())
    out += complete ? "It stays where it is: the others were taken from it.\n" : "Nothing is on record about it.\n";
  return out;
}

}  // namespace dismantle
