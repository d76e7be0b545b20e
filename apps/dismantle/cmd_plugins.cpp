// dismantle plugins list | describe ID
#include <fmt/format.h>

#include <algorithm>

#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/host/describe.h"
#include "dismantle/settings.h"

namespace dismantle::app {
namespace {

struct Plugins {
  ConfigFlags config;
  std::string id, format = "text";
};

/// With a configuration its search paths count too.
void scan(const Plugins& options, Registry& registry) {
  if (options.config.source().file)
    load_config(options.config.source(), registry);
  else
    registry.scan();
}

int list(const Plugins& options) {
  Console console(ConsoleOptions{});
  Registry registry;
  scan(options, registry);
  std::string out;
  std::size_t width = 0;
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry.types(kind)) width = std::max(width, type->type.id.size());
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry.types(kind))
      out += fmt::format("{:<{}}  {:<16}  {}\n{:<{}}  {:<16}  {} {}, {}\n", type->type.id, width, to_string(kind),
                         type->type.summary, "", width, "", type->file->id, type->file->version,
                         type->file->path.string());
  if (out.empty()) {
    out = "no plugins found; searched:\n";
    for (const auto& path : registry.search_paths()) out += fmt::format("  {}\n", path.string());
  }
  console.text(out);
  warn_of_problems(registry, console);
  return kComplete;
}

int describe(const Plugins& options) {
  Registry registry;
  scan(options, registry);
  if (registry.lookup(options.id) == nullptr)
    throw ConfigError({Diagnostic{"", 0, 0, registry.why_missing(options.id)}});
  const RegisteredType& type = registry.find(options.id);
  std::string out;
  if (options.format == "markdown")
    out = describe_markdown(type.type, *type.file);
  else if (options.format == "json")
    out = describe_json(type.type, *type.file);
  else
    out = describe_text(type.type, *type.file);
  if (out.empty() || out.back() != '\n') out += '\n';
  Console(ConsoleOptions{}).text(out);
  return kComplete;
}

}  // namespace

void add_plugins(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plugins", "Show the simulators, planners and importers that are there");
  command->require_subcommand(1);
  command->footer(
      "Plugins are found in the install's plugin folder, in $DISMANTLE_PLUGIN_PATH and in the search paths of the\n"
      "configuration.\n"
      "Examples:\n"
      "  dismantle plugins list\n"
      "  dismantle plugins describe bfs");
  auto options = std::make_shared<Plugins>();

  auto* list_command = command->add_subcommand("list", "All ids with kind, summary and file");
  options->config.add_file_and_set(*list_command);
  list_command->footer("Example:\n  DISMANTLE_PLUGIN_PATH=build dismantle plugins list");
  list_command->callback([&action, options] { action = [options] { return list(*options); }; });

  auto described = std::make_shared<Plugins>();
  auto* describe_command = command->add_subcommand("describe", "What a plugin does, and its parameters");
  describe_command->add_option("ID", described->id, "Id as in 'plugins list'")->required()->option_text(" ");
  describe_command->add_option("--format", described->format, "text, markdown or json")
      ->check(CLI::IsMember({"text", "markdown", "json"}).description(""))
      ->option_text("text|markdown|json");
  described->config.add_file_and_set(*describe_command);
  describe_command->footer("Example:\n  dismantle plugins describe sdf_penalty --format markdown");
  describe_command->callback([&action, described] { action = [described] { return describe(*described); }; });
}

}  // namespace dismantle::app
