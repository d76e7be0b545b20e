// dismantle completion bash|zsh|fish, and the manual page for the build
#include <fmt/format.h>

#include "command.h"
#include "completion.h"

namespace dismantle::app {

void add_completion(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("completion", "Print a script that completes commands and options in a shell");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  source <(dismantle completion bash)\n"
      "  dismantle completion zsh > _dismantle\n"
      "  dismantle completion fish > ~/.config/fish/completions/dismantle.fish");
  const auto add = [&](CLI::App& parent, const std::string& name, const std::string& help, auto* print) {
    auto* shell = parent.add_subcommand(name, help);
    shell->callback([&action, &app, print] {
      action = [&app, print] {
        fmt::print("{}", print(command_tree(app)));
        return static_cast<int>(kComplete);
      };
    });
    return shell;
  };
  add(*command, "bash", "For bash: source it", &bash_completion);
  add(*command, "zsh", "For zsh: a file _dismantle in a folder of $fpath", &zsh_completion);
  add(*command, "fish", "For fish: a file dismantle.fish in ~/.config/fish/completions", &fish_completion);
  add(app, "manual-page", "The manual page, in troff", &manual_page)->group("");  // used by the build
}

}  // namespace dismantle::app
