// dismantle verify PLAN.json
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/errors.h"
#include "dismantle/host/planning_setup.h"
#include "dismantle/loaded_plan.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/report_text.h"
#include "dismantle/stopped.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::app {
namespace {

struct Verify {
  std::string plan, assembly;
  double effort = 1;
  ConsoleOptions console;
};

/// The tolerance of the verification: that of the plan, limited to the largest one for valid plans. A plan states its
/// own scale, so the tolerance is also bounded relative to the size of the assembly. A plan with a wrong scale thus
/// cannot increase it.
double tolerance_of(const Plan& plan, const Assembly& assembly, Console& console) {
  const double most = VerifyOptions{}.max_penetration, usual_size = PrepareOptions{}.size;
  if (plan.verified_max_penetration > most)
    console.warning(
        fmt::format("the plan was made with a tolerance of {:.3g}; it is verified with {:.3g} assembly units",
                    plan.verified_max_penetration, most));
  const double size = assembly.normalization.scale * assembly.input_box.size().maxCoeff();
  const double tolerance = std::min({plan.verified_max_penetration, most, most / usual_size * size});
  if (std::abs(size - usual_size) > 1e-6)
    console.warning(
        fmt::format("the largest edge of the assembly is {:.6g} of the plan's units, usually it is {:g}: the "
                    "tolerance is {:.2g} of it",
                    size, usual_size, tolerance / size));
  return tolerance;
}

int verify(const Verify& options) {
  Console console(options.console);
  Registry registry;
  RunContext context = context_for_reading(registry, console);
  const auto [plan, assembly] = load_plan(options.plan, options.assembly, registry, context);
  VerifyOptions tolerance;
  tolerance.max_penetration = tolerance_of(plan, assembly, console);
  tolerance.budget = tolerance.budget.times(options.effort);
  if (const SurfaceRepair& r = plan.assembly.repair; r != SurfaceRepair{})
    console.warning(fmt::format(
        "the plan was made with weld: {:g}, repair: {}, max_hole: {:g}; surfaces are verified as repaired with these",
        r.weld, r.repair, r.max_hole));
  PlanCheck check = check_plan(plan, assembly, tolerance, context, prover_of_kind(registry));
  judge_again(check, plan, assembly, check_of_type(registry), context);
  console.end_progress();
  if (context.cancel.cancelled()) throw Stopped(context, "interrupted before all steps were checked");

  console.text(check_text(plan, check));
  auto problems = nlohmann::ordered_json::array();
  for (const auto& p : check.problems) problems.push_back({{"step", p.step}, {"message", p.message}});
  console.result({{"status", !check.valid                        ? "invalid"
                             : check.complete                    ? "complete"
                             : plan.status == PlanStatus::forced ? "forced"
                                                                 : "partial"},
                  {"parts", assembly.parts.size()},
                  {"steps", plan.disassembly.size()},
                  {"max_penetration", check.max_penetration},
                  {"forced", check.forced},
                  {"certificates", check.certificates},
                  {"checked_independently", check.certificates - check.checked_by_prover},
                  {"checked_by_prover", check.checked_by_prover},
                  {"verdicts", check.verdicts},
                  {"not_checked", check.not_checked},
                  {"problems", problems},
                  {"plan", options.plan}});
  return check.valid && check.complete ? kComplete : kPartial;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("verify", "Check a plan against the original triangles, independently of its planner");
  auto options = std::make_shared<Verify>();
  command->add_option("PLAN.json", options->plan, "Plan file")->required()->option_text(" ");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  command
      ->add_option("--effort", options->effort,
                   "Multiplies the tests and patches that each proof may take: for plans that were made with more")
      ->check(CLI::Range(1.0, 1000.0))
      ->option_text("X");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Example:\n"
      "  dismantle verify out/plan.json --assembly gearbox/\n"
      "Exit status: 0 valid and complete; 1 valid but partial, or not valid; 3 the plan or the input cannot be used.");
  command->callback([&action, options] { action = [options] { return verify(*options); }; });
}

}  // namespace dismantle::app
