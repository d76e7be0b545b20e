#include "command_tree.h"

#include <fmt/format.h>

#include <sstream>

namespace dismantle::app {
namespace {

/// "text|json" -> text, json. A placeholder such as "DIR" has no choices.
std::vector<std::string> choices_of(const std::string& value) {
  std::vector<std::string> out;
  if (value.find('|') == std::string::npos || value.find(' ') != std::string::npos) return out;
  std::istringstream words(value);
  for (std::string word; std::getline(words, word, '|');) out.push_back(word);
  for (const std::string& word : out)
    if (word.empty() || word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string::npos) return {};
  return out;
}

CommandOption option_of(const CLI::Option& option) {
  CommandOption out;
  for (const auto& name : option.get_snames()) out.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) out.names.push_back("--" + name);
  if (out.names.empty()) out.names.push_back(option.get_name());
  if (option.get_items_expected_max() > 0) {
    out.value = option.get_option_text();
    if (out.value.find_first_not_of(' ') == std::string::npos) out.value = "VALUE";
    out.choices = choices_of(out.value);
  }
  out.help = option.get_description();
  return out;
}

CommandNode node_of(const CLI::App& app, std::vector<std::string> path) {
  CommandNode node;
  path.push_back(app.get_name());
  node.path = path;
  node.help = app.get_description();
  node.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      (option->get_positional() ? node.arguments : node.options).push_back(option_of(*option));
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) node.commands.push_back(node_of(*command, path));
  return node;
}

}  // namespace

std::string CommandNode::name() const { return fmt::format("{}", fmt::join(path, " ")); }

CommandNode command_tree(const CLI::App& app) { return node_of(app, {}); }

std::vector<const CommandNode*> all_of(const CommandNode& node) {
  std::vector<const CommandNode*> out{&node};
  for (const CommandNode& command : node.commands)
    for (const CommandNode* below : all_of(command)) out.push_back(below);
  return out;
}

}  // namespace dismantle::app
