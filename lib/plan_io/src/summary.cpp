#include "dismantle/plan_io/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "dismantle/plan_io/text_columns.h"

namespace dismantle {
namespace {

const char* meaning(Outcome outcome) {
  switch (outcome) {
    case Outcome::solved:
      return "a way was found";
    case Outcome::start_is_goal:
      return "it was out already";
    case Outcome::timeout:
      return "the budget of time or steps was used up; more may help";
    case Outcome::depth_limit:
      return "searched to the depth allowed; deeper may help";
    case Outcome::exhausted:
      return "nothing was left to search at this resolution";
    case Outcome::infeasible:
      return "proved: no motion separates it from what holds it";
    case Outcome::invalid_start:
      return "its start is not valid: it penetrates another part beyond what was measured";
    case Outcome::cancelled:
      return "the run was stopped";
    case Outcome::unsupported:
      return "the simulator cannot do what the planner needs";
    case Outcome::crashed:
      return "the planner failed";
  }
  return "";
}

double size_of(const Plan& plan) { return plan.assembly.box.empty() ? 0 : plan.assembly.box.size().maxCoeff(); }

/// How far `pose` is from the assembled one, as seen at the middle of the assembly.
std::string way_text(const Plan& plan, const Pose& pose) {
  if (pose.is_identity()) return "it did not move";
  const Eigen::Vector3d& middle = plan.assembly.center;
  const double way = (pose * middle - middle).norm(), size = size_of(plan);
  std::string out = fmt::format("{:.3g} input units", way);
  if (size > 0) out += fmt::format(" ({:.1f} % of the assembly's largest edge)", 100 * way / size);
  const double angle = angle_between(pose.q, Eigen::Quaterniond::Identity()) * 180 / std::numbers::pi;
  if (angle > 0.05) out += fmt::format(", turned by {:.1f} degrees", angle);
  return out;
}

std::string excluded_text(const std::vector<std::pair<std::string, std::string>>& excluded) {
  std::string out;
  for (const auto& [name, reason] : excluded) out += fmt::format("left out: {}: {}\n", name, reason);
  return out;
}

}  // namespace

std::string summary_text(const Plan& plan) {
  const auto& a = plan.assembly;
  double worst = 0;
  for (const auto& step : plan.disassembly) worst = std::max(worst, step.max_penetration);
  std::string out = fmt::format("{}: {}, {}, {}\n", a.source, text::counted(a.parts.size(), "part"),
                                text::counted(plan.disassembly.size(), "step"),
                                plan.status == PlanStatus::complete ? "complete" : "partial");
  const std::size_t width = text::widest_step(plan);
  for (const auto& step : plan.disassembly)
    out += fmt::format("{:>5}  {}  {:8.2f} s  penetration <= {:.2g}\n", step.step,
                       text::padded(text::names_of(step), width), step.seconds, step.max_penetration);
  if (!plan.disassembly.empty())
    out += fmt::format("every step is verified: penetration <= {:.2g} of {:.2g} allowed (assembly units)\n", worst,
                       plan.verified_max_penetration);
  if (plan.assembly_status == AssemblyStatus::complete)
    out += fmt::format("assembly: {} from the layout, verified likewise\n",
                       text::counted(plan.assembly_steps.size(), "step"));
  if (plan.assembly_status == AssemblyStatus::partial)
    out += fmt::format("assembly: partial: {}\n", plan.assembly_message);
  if (!plan.remaining.empty()) out += fmt::format("stays: {}\n", text::joined(plan.remaining));
  out += excluded_text(a.excluded);
  for (const auto& u : plan.unsolved) {
    out += fmt::format("unsolved: {}: {}", u.part, to_string(u.outcome));
    if (!u.blocked_by.empty()) out += fmt::format(", blocked by {}", text::joined(u.blocked_by));
    out += '\n';
  }
  return out;
}

std::string explain_text(const Plan& plan) {
  const auto& a = plan.assembly;
  std::string out = fmt::format("{}: {}, {} done, {} not removed\n", a.source, text::counted(a.parts.size(), "part"),
                                text::counted(plan.disassembly.size(), "step"), plan.remaining.size());
  out += excluded_text(a.excluded);
  if (plan.status == PlanStatus::complete) return out + "Every part came out: there is nothing to explain.\n";
  if (plan.unsolved.empty()) out += "No attempt that failed is on record: the parts that remain were not tried.\n";
  for (const auto& u : plan.unsolved) {
    out += fmt::format("\n{} did not come out: {} ({})\n", u.part, meaning(u.outcome), to_string(u.outcome));
    if (u.blocked_by.empty())
      out += "  blocked by: no contact is on record\n";
    else
      out += fmt::format("  blocked by: {} (touched most often first)\n", text::joined(u.blocked_by));
    out += fmt::format("  came furthest: {}\n", way_text(plan, u.best_pose));
    for (const auto& o : a.overlaps)
      if (o.a == u.part || o.b == u.part)
        out +=
            fmt::format("  overlaps {} by {:.2g} assembly units when assembled\n", o.a == u.part ? o.b : o.a, o.depth);
    if (!u.message.empty()) out += fmt::format("  said: {}\n", u.message);
    if (u.certificate && *u.certificate < plan.certificates.size()) {
      const PlanCertificate& c = plan.certificates[*u.certificate];
      out += fmt::format("  certificate {} ({}), {}; `dismantle verify` checks it again\n", *u.certificate, c.kind,
                         c.full_tolerance
                             ? std::string("for all motions within the tolerance")
                             : fmt::format("for motions that cut in by no more than {:.4g} assembly units", c.margin));
      if (c.text != u.message) out += fmt::format("    {}\n", c.text);
    }
  }
  return out;
}

}  // namespace dismantle
