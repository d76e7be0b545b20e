// dismantle explain PLAN.json
#include <fmt/format.h>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/host/suggest.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/session/session.h"
#include "frame_options.h"

namespace dismantle::app {
namespace {

struct ExplainOptions {
  std::string file, part, show_unit;
  ConsoleOptions console;
};

void check_part(const Plan& plan, const std::string& part, const std::string& file) {
  std::vector<std::string> names;
  for (const auto& p : plan.assembly.parts) names.push_back(p.name);
  for (const PlanExcluded& e : plan.assembly.excluded)
    if (e.name == part) throw InputError(file, fmt::format("part '{}' was left out of the plan: {}", part, e.reason));
  if (part.empty() || std::find(names.begin(), names.end(), part) != names.end()) return;
  const auto near = nearest(part, names);
  throw InputError(file, fmt::format("the plan has no part '{}'{}", part,
                                     near ? fmt::format("; did you mean '{}'?", *near)
                                          : fmt::format("; its parts: {}", fmt::join(names, ", "))));
}

int explain_plan(const ExplainOptions& options) {
  Console console(options.console);
  const Plan plan = read_plan(options.file);
  check_part(plan, options.part, options.file);
  const Explanation why = explain(plan, settings_beside(options.file), options.part);
  const InputFrame frame = shown_in(input_frame(plan.assembly), options.show_unit);
  console.text(explain_text(why, text_unit(frame, plan.assembly.box, "input units")));
  if (options.console.format == Format::json) {
    auto result = nlohmann::ordered_json::parse(explain_json(why));
    result["plan"] = options.file;
    console.result(std::move(result));
  }
  return kComplete;
}

}  // namespace

void add_explain(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "explain", "Say why parts did not come out, what to do about it, and why the others came out in this order");
  auto options = std::make_shared<ExplainOptions>();
  command->add_option("PLAN.json", options->file, "Plan file")->required()->option_text(" ");
  command->add_option("--part", options->part, "Only this part")->option_text("NAME");
  add_show_unit(*command, options->show_unit);
  add_format(*command, options->console);
  command->footer(
      "Lengths in JSON are in the unit of the input. Values of the run are read from resolved.yaml beside the plan.\n"
      "Example:\n  dismantle explain out/plan.json --part shaft_1");
  command->callback([&action, options] { action = [options] { return explain_plan(*options); }; });
}

}  // namespace dismantle::app
