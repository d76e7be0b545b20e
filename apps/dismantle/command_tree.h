/// The commands and options, read from the parser, so that completion and the manual page agree with it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dismantle::app {

struct CommandOption {
  std::vector<std::string> names;    ///< "-o", "--output"
  std::string value;                 ///< as shown in the help, "DIR"; empty: a flag
  std::vector<std::string> choices;  ///< for a value such as "text|json"; empty: any value
  std::string help;
};

struct CommandNode {
  std::vector<std::string> path;  ///< {"dismantle", "plugins", "list"}
  std::string help, footer;
  std::vector<CommandOption> options;
  std::vector<CommandOption> arguments;  ///< positional; one name each
  std::vector<CommandNode> commands;

  std::string name() const;  ///< "dismantle plugins list"
};

/// The tree of all commands that the help shows.
CommandNode command_tree(const CLI::App& app);
/// The node and all below it, parents first.
std::vector<const CommandNode*> all_of(const CommandNode& node);

}  // namespace dismantle::app
