#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/plan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace dismantle {
namespace {

std::size_t width_of(const std::string& utf8) {
  return static_cast<std::size_t>(std::ranges::count_if(utf8, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(std::string text, std::size_t width) {
  const std::size_t now = width_of(text);
  return now < width ? text.append(width - now, ' ') : text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string counted(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

std::string movers(const PlanStep& step) {
  std::vector<std::string> names;
  for (const auto& move : step.moves) names.push_back(move.part);
  return joined(names);
}

std::size_t widest_mover(const Plan& plan) {
  std::size_t width = 4;
  for (const auto& step : plan.disassembly) width = std::max(width, std::min<std::size_t>(width_of(movers(step)), 40));
  return width;
}

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
  std::string out = fmt::format("{}: {}, {}, {}\n", a.source, counted(a.parts.size(), "part"),
                                counted(plan.disassembly.size(), "step"),
                                plan.status == PlanStatus::complete ? "complete" : "partial");
  const std::size_t width = widest_mover(plan);
  for (const auto& step : plan.disassembly)
    out += fmt::format("{:>5}  {}  {:8.2f} s  penetration <= {:.2g}\n", step.step, padded(movers(step), width),
                       step.seconds, step.max_penetration);
  if (!plan.disassembly.empty())
    out += fmt::format("every step is verified: penetration <= {:.2g} of {:.2g} allowed (assembly units)\n", worst,
                       plan.verified_max_penetration);
  if (plan.assembly_status == AssemblyStatus::complete)
    out +=
        fmt::format("assembly: {} from the layout, verified likewise\n", counted(plan.assembly_steps.size(), "step"));
  if (plan.assembly_status == AssemblyStatus::partial)
    out += fmt::format("assembly: partial: {}\n", plan.assembly_message);
  if (!plan.remaining.empty()) out += fmt::format("stays: {}\n", joined(plan.remaining));
  out += excluded_text(a.excluded);
  for (const auto& u : plan.unsolved) {
    out += fmt::format("unsolved: {}: {}", u.part, to_string(u.outcome));
    if (!u.blocked_by.empty()) out += fmt::format(", blocked by {}", joined(u.blocked_by));
    out += '\n';
  }
  return out;
}

std::string explain_text(const Plan& plan) {
  const auto& a = plan.assembly;
  std::string out = fmt::format("{}: {}, {} done, {} not removed\n", a.source, counted(a.parts.size(), "part"),
                                counted(plan.disassembly.size(), "step"), plan.remaining.size());
  out += excluded_text(a.excluded);
  if (plan.status == PlanStatus::complete) return out + "Every part came out: there is nothing to explain.\n";
  if (plan.unsolved.empty()) out += "No attempt that failed is on record: the parts that remain were not tried.\n";
  for (const auto& u : plan.unsolved) {
    out += fmt::format("\n{} did not come out: {} ({})\n", u.part, meaning(u.outcome), to_string(u.outcome));
    if (u.blocked_by.empty())
      out += "  blocked by: no contact is on record\n";
    else
      out += fmt::format("  blocked by: {} (touched most often first)\n", joined(u.blocked_by));
    out += fmt::format("  came furthest: {}\n", way_text(plan, u.best_pose));
    for (const auto& o : a.overlaps)
      if (o.a == u.part || o.b == u.part)
        out +=
            fmt::format("  overlaps {} by {:.2g} assembly units when assembled\n", o.a == u.part ? o.b : o.a, o.depth);
    if (!u.message.empty()) out += fmt::format("  said: {}\n", u.message);
  }
  return out;
}

std::string check_text(const Plan& plan, const PlanCheck& check) {
  std::string out = fmt::format("{}: {}\n", plan.assembly.source, counted(plan.disassembly.size(), "step"));
  const std::size_t width = widest_mover(plan);
  for (std::size_t i = 0; i < plan.disassembly.size(); ++i) {
    const auto& step = plan.disassembly[i];
    const bool bad = std::ranges::any_of(check.problems, [&](const PlanProblem& p) { return p.step == step.step; });
    out += fmt::format("{:>5}  {}  ", step.step, padded(movers(step), width));
    if (bad)
      out += "NOT VALID\n";
    else if (i < check.step_penetration.size())
      out += fmt::format("valid, penetration <= {:.2g}\n", check.step_penetration[i]);
    else
      out += "not checked\n";
  }
  for (const auto& p : check.problems)
    out += p.step == 0 ? fmt::format("problem: {}\n", p.message)
                       : fmt::format("problem in step {}: {}\n", p.step, p.message);
  if (!check.valid) return out + "The plan is NOT VALID.\n";
  out += fmt::format("The plan is valid, penetration <= {:.2g} assembly units, and {}.\n", check.max_penetration,
                     check.complete ? "complete" : "partial: some parts are still together");
  return out;
}

std::string prepare_text(const Assembly& assembly, const PrepareReport& report) {
  std::size_t width = 4;
  for (const auto& part : report.parts) width = std::max(width, std::min<std::size_t>(width_of(part.name), 40));
  std::string out = fmt::format("{}: {} read, {} kept\n", assembly.source, counted(report.parts.size(), "part"),
                                assembly.parts.size());
  out += fmt::format("  {}  {:>9}  {:>6}  {:>12}  done\n", padded("part", width), "triangles", "shells", "volume");
  for (const auto& part : report.parts) {
    std::string done = part.kept ? "" : "LEFT OUT: " + part.reason;
    for (const auto& action : part.actions) done += (done.empty() ? "" : "; ") + action;
    out += fmt::format("  {}  {:>9}  {:>6}  {:>12.6g}  {}\n", padded(part.name, width), part.triangles, part.shells,
                       part.volume, done.empty() ? "nothing" : done);
  }
  for (const auto& o : assembly.overlaps)
    out += fmt::format("overlap when assembled: {} and {}, {:.2g} assembly units\n", assembly.parts[o.a].name,
                       assembly.parts[o.b].name, o.depth);
  for (const auto& warning : report.warnings) out += fmt::format("warning: {}\n", warning);
  const Eigen::Vector3d size = assembly.input_box.size();
  out += fmt::format("size {:.6g} x {:.6g} x {:.6g} input units, scale {:.6g}\n", size.x(), size.y(), size.z(),
                     assembly.normalization.scale);
  return out;
}

}  // namespace dismantle
