#include "report_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {

std::string check_text(const Plan& plan, const PlanCheck& check) {
  std::string out = fmt::format("{}: {}\n", plan.assembly.source, text::counted(plan.disassembly.size(), "step"));
  const std::size_t width = text::widest_step(plan);
  const double scale = plan.assembly.scale > 0 ? plan.assembly.scale : 1;  // the report uses input units
  for (std::size_t i = 0; i < plan.disassembly.size(); ++i) {
    const auto& step = plan.disassembly[i];
    const bool bad = std::ranges::any_of(check.problems, [&](const PlanProblem& p) { return p.step == step.step; });
    out += fmt::format("{:>5}  {}  ", step.step, text::padded(text::names_of(plan, step), width));
    if (bad)
      out += "NOT VALID\n";
    else if (step.forced)
      out += fmt::format("{}: {}; measured again: {}\n", step.forced->accepted.empty() ? "FORCED" : "accepted",
                         forced_text(plan, *step.forced), length_text(plan, check.forced_depth.at(i) / scale));
    else if (i < check.step_penetration.size())
      out += fmt::format("valid, penetration <= {}\n{}", length_text(plan, check.step_penetration[i] / scale),
                         overlaps_text(plan, step));
    else
      out += "not checked\n";
  }
  for (const auto& p : check.problems)
    out += p.step == 0 ? fmt::format("problem: {}\n", p.message)
                       : fmt::format("problem in step {}: {}\n", p.step, p.message);
  for (const auto& text : check.not_checked)
    out += fmt::format("not checked here: {}{}\n", text.starts_with('\'') ? "the verdicts of " : "", text);
  if (!check.valid) return out + "The plan is NOT VALID.\n";
  if (check.verdicts > 0)
    out += fmt::format("{} of step checks: judged again, with the same result.\n",
                       text::counted(check.verdicts, "verdict"));
  if (check.certificates > 0)
    out += fmt::format("{} that parts cannot be separated {}: {} checked independently, {} by {}.\n",
                       text::counted(check.certificates, "proof"), check.certificates == 1 ? "holds" : "hold",
                       check.certificates - check.checked_by_prover, check.checked_by_prover,
                       check.checked_by_prover == 1 ? "its own prover" : "their own provers");
  out += fmt::format("The plan is valid, penetration <= {}, and {}.\n",
                     length_text(plan, check.max_penetration / scale), result_text(plan));
  return out;
}

std::string prepare_text(const Assembly& assembly, const PrepareReport& report, bool verbose) {
  std::size_t width = 4;
  for (const auto& part : report.parts) width = text::column_of(width, part.name);
  std::string out = fmt::format("{}: {} read, {} kept\n", assembly.source, text::counted(report.parts.size(), "part"),
                                assembly.parts.size());
  out +=
      fmt::format("  {}  {:>9}  {:>6}  {:>12}  done\n", text::padded("part", width), "triangles", "shells", "volume");
  for (const auto& part : report.parts) {
    std::string done = part.kept ? "" : "LEFT OUT: " + part.reason;
    for (const auto& action : verbose ? part.actions : part.summary) done += (done.empty() ? "" : "; ") + action;
    out += fmt::format("  {}  {:>9}  {:>6}  {:>12.6g}  {}\n", text::padded(part.name, width), part.triangles,
                       part.shells, part.volume, done.empty() ? "nothing" : done);
  }
  for (const auto& o : assembly.overlaps)
    out += fmt::format("overlap when assembled: {} and {}, {:.3g} {}{}\n", assembly.parts[o.a].name,
                       assembly.parts[o.b].name, o.depth / assembly.normalization.scale,
                       assembly.unit.empty() ? "input units" : assembly.unit,
                       o.place ? fmt::format(", {}", to_string(o.place->contact)) : "");
  for (const auto& warning : report.warnings) out += fmt::format("warning: {}\n", warning);
  const Eigen::Vector3d size = assembly.input_box.size();
  out += fmt::format("size {:.6g} x {:.6g} x {:.6g} input units, scale {:.6g}\n", size.x(), size.y(), size.z(),
                     assembly.normalization.scale);
  return out;
}

}  // namespace dismantle
