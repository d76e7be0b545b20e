// dismantle verify PLAN.json
#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/summary.h"
#include "plan_report.h"
#include "report_text.h"
#include "settings.h"
#include "stability_file.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct Verify {
  std::string plan, assembly, config;
  double effort = 1;
  ConsoleOptions console;
};

/// A reader that also finds the plugins of a configuration.
Session reader_of(const std::string& config, Console& console) {
  const auto plugins = std::make_shared<Registry>();
  ConfigSource source;
  source.file = config;
  if (!config.empty()) load_config(source, *plugins);
  Session session = Session::reader(plugins);
  warn_of_problems(session.registry(), console);
  return session;
}

int verify(const Verify& options) {
  Console console(options.console);
  if (is_stability_file(options.plan)) return verify_stability(options.plan, options.assembly, console);
  const Session session = reader_of(options.config, console);
  RunContext context = context_of(session, console);
  const auto [plan, assembly] =
      stoppable(context, [&] { return session.load_plan(options.plan, options.assembly, context); });
  const PlanCheck check = session.verify(plan, assembly, context, {.effort = options.effort});
  console.end_progress();
  if (context.cancel.cancelled()) throw Stopped(context, "interrupted before all steps were checked");

  console.text(check_text(plan, check));
  auto problems = nlohmann::ordered_json::array();
  for (const auto& p : check.problems) problems.push_back({{"step", p.step}, {"message", p.message}});
  console.result({{"status", check.valid ? result_word(plan) : "invalid"},
                  {"reason", check.valid ? reason_of(plan) : nlohmann::ordered_json("invalid")},
                  {"asked", asked_json(plan.asked)},
                  {"parts", assembly.parts.size()},
                  {"steps", plan.disassembly.size()},
                  {"max_penetration", check.max_penetration},
                  {"forced", check.forced},
                  {"accepted", check.accepted},
                  {"certificates", check.certificates},
                  {"checked_independently", check.certificates - check.checked_by_prover},
                  {"checked_by_prover", check.checked_by_prover},
                  {"verdicts", check.verdicts},
                  {"not_checked", check.not_checked},
                  {"problems", problems},
                  {"plan", options.plan}});
  return check.valid && plan.succeeded() ? kComplete : kPartial;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("verify", "Check a plan against the original triangles, independently of its planner");
  auto options = std::make_shared<Verify>();
  command->add_option("PLAN.json", options->plan, "Plan file, or stability.json")->required()->option_text(" ");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  command
      ->add_option("-c,--config", options->config,
                   "Configuration whose plugins.search_paths have the checkers of third parties' proofs and verdicts")
      ->option_text("CONFIG.yaml");
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
