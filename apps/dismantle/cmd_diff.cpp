// dismantle diff OLD NEW
#include <fmt/format.h>

#include <optional>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/session/revision.h"
#include "dismantle/session/session.h"
#include "revision_report.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct DiffOptions {
  std::string before, now;
  ConfigFlags config;
  ConsoleOptions console;
};

/// An input, or a plan with its input.
struct Side {
  Assembly assembly;
  std::optional<Plan> plan;
};

Side load(const std::string& what, const Session& session, const RunContext& context) {
  if (!what.ends_with(".json")) return {*session.load(what, context).assembly, {}};
  LoadedPlan loaded = session.load_plan(what, {}, context);
  return {std::move(loaded.assembly), std::move(loaded.plan)};
}

std::string line_of(const PartRevision& part) {
  switch (part.fate) {
    case PartFate::same:
      return {};
    case PartFate::moved:
      return fmt::format("moved    {}\n", part.now);
    case PartFate::changed:
      return fmt::format("changed  {}\n", part.now);
    case PartFate::renamed:
      return fmt::format("renamed  {} -> {}\n", part.before, part.now);
    case PartFate::added:
      return fmt::format("added    {}\n", part.now);
    case PartFate::removed:
      return fmt::format("removed  {}\n", part.before);
  }
  return {};
}

int diff(const DiffOptions& options) {
  Console console(options.console);
  const Session session(options.config.source());
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  const auto [before, now] = stoppable(context, [&] {
    return std::pair{load(options.before, session, context), load(options.now, session, context)};
  });
  std::string text;
  auto parts = nlohmann::ordered_json::array();
  std::size_t same = 0;
  for (const PartRevision& part : revised_parts(before.assembly, now.assembly)) {
    same += part.fate == PartFate::same;
    text += line_of(part);
    parts.push_back({{"fate", to_string(part.fate)}, {"before", part.before}, {"now", part.now}});
  }
  const bool parts_differ = same < parts.size();
  text += fmt::format("{} of {} parts are the same\n", same, parts.size());
  nlohmann::ordered_json json = {{"status", "complete"}, {"parts", parts}, {"plan", nullptr}};
  bool steps_differ = false;
  if (before.plan) {
    VerifyOptions verify = session.config().verify;
    verify.max_penetration = before.plan->verified_max_penetration;
    const KeptSteps kept = stoppable(context, [&] {
      return kept_steps(*before.plan, now.assembly, {}, Verifier(now.assembly, verify, context), context);
    });
    if (context.should_stop()) throw Stopped(context, "stopped before all steps were verified");
    for (const StepRevision& step : kept.revisions) steps_differ = steps_differ || !step.kept;
    text += kept_text(kept, options.before);
    json["revised"] = revised_json(kept);
  }
  console.end_progress();
  json["differ"] = parts_differ || steps_differ;
  json["reason"] = parts_differ || steps_differ ? nlohmann::ordered_json("differ") : nlohmann::ordered_json();
  console.text(text);
  console.result(std::move(json));
  return parts_differ || steps_differ ? kPartial : kComplete;
}

}  // namespace

void add_diff(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("diff", "What changed between two revisions of an assembly");
  auto options = std::make_shared<DiffOptions>();
  command->add_option("OLD", options->before, "Plan (.json) or input of the earlier revision")
      ->required()
      ->option_text(" ");
  command->add_option("NEW", options->now, "Plan (.json) or input of the later revision")->required()->option_text(" ");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Parts are compared by name, shape and place; one whose name alone changed is renamed. If OLD is a plan, each "
      "of\n"
      "its steps is verified in the new assembly; 'dismantle plan' can keep those that hold and plan the rest "
      "(docs/cli.md).\n"
      "Exit status: 0 nothing differs and all steps hold, 1 otherwise.\n"
      "Examples:\n"
      "  dismantle diff gearbox_a.step gearbox_b.step\n"
      "  dismantle diff gearbox_a.plan/plan.json gearbox_b.step");
  command->callback([&action, options] { action = [options] { return diff(*options); }; });
}

}  // namespace dismantle::app
