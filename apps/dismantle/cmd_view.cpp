// dismantle view PLAN.json
#include <fmt/format.h>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct ViewOptions {
  std::string plan, assembly, output;
  ConsoleOptions console;
};

int view(const ViewOptions& options) {
  Console console(options.console);
  if (!has_viewer()) throw Error(kNoViewer);
  const Session session = reader(console);
  RunContext context = context_of(session, console);
  const auto [plan, assembly] =
      stoppable(context, [&] { return session.load_plan(options.plan, options.assembly, context); });
  const std::filesystem::path page = options.output.empty()
                                         ? std::filesystem::path(options.plan).replace_filename("index.html")
                                         : std::filesystem::path(options.output);
  write_file(page, page_of(plan, assembly, settings_beside(options.plan)));
  console.end_progress();
  console.text(fmt::format("wrote {}: open it in a browser\n", page.string()));
  console.result({{"status", result_word(plan)},
                  {"parts", assembly.parts.size()},
                  {"steps", plan.disassembly.size()},
                  {"page", page.string()},
                  {"plan", options.plan}});
  return kComplete;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("view", "Write a page that shows a plan in a browser, without a network");
  auto options = std::make_shared<ViewOptions>();
  command->add_option("PLAN.json", options->plan, "Plan file")->required()->option_text(" ");
  command->add_option("-o,--output", options->output, "The page to write; default: index.html beside the plan")
      ->option_text("FILE.html");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "'dismantle plan' writes this page by itself; this is for plans that have none, or that came without it.\n"
      "Example:\n"
      "  dismantle view out/plan.json -o gearbox.html");
  command->callback([&action, options] { action = [options] { return view(*options); }; });
}

}  // namespace dismantle::app
