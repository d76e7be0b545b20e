// dismantle explain PLAN.json
#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_file.h"

namespace dismantle::app {

void add_explain(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("explain", "Say why parts did not come out: what was tried, what blocked it, where");
  auto file = std::make_shared<std::string>();
  command->add_option("PLAN.json", *file, "Plan file")->required()->option_text(" ");
  command->footer("Example:\n  dismantle explain out/plan.json");
  command->callback([&action, file] {
    action = [file] {
      Console(ConsoleOptions{}).text(explain_text(read_plan(*file)));
      return static_cast<int>(kComplete);
    };
  });
}

}  // namespace dismantle::app
