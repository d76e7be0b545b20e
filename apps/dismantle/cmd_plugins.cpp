// dismantle plugins list | describe ID | check FILE | new DIR
#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "console.h"
#include "dismantle/host/describe.h"
#include "plugin_template.h"
#include "plugins_check.h"
#include "settings.h"

namespace dismantle::app {
namespace {

struct Plugins {
  ConfigFlags config;
  std::string id, format = "text";
};

/// Scans for plugins, also in the search paths of the configuration if there is one.
void scan(const Plugins& options, Registry& registry) {
  if (options.config.source().file)
    load_config(options.config.source(), registry);
  else
    registry.scan();
}

/// The file that a type comes from.
std::string origin_of(const RegisteredType& type) {
  if (!type.preset_of.empty()) return fmt::format("preset of {}, {}", type.preset_of, type.preset_file.string());
  return fmt::format("{} {}, {}", type.file->id, type.file->version, type.file->path.string());
}

int list(const Plugins& options) {
  Console console(ConsoleOptions{});
  Registry registry;
  scan(options, registry);
  registry.load_all();
  std::string out;
  std::size_t width = 0;
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry.types(kind)) width = std::max(width, type->type.id.size());
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry.types(kind))
      out += fmt::format("{:<{}}  {:<16}  {}\n{:<{}}  {:<16}  {}\n", type->type.id, width, to_string(kind),
                         type->type.summary, "", width, "", origin_of(*type));
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
    out = describe_markdown(type, registry);
  else if (options.format == "json")
    out = describe_json(type, registry);
  else
    out = describe_text(type, registry);
  if (out.empty() || out.back() != '\n') out += '\n';
  Console(ConsoleOptions{}).text(out);
  return kComplete;
}

struct NewPlugin {
  std::string folder, kind, id;
};

int make_new(const NewPlugin& options) {
  std::string out = fmt::format("wrote to {}:", options.folder);
  for (const auto& file : write_plugin_project(options.folder, options.kind, options.id)) out += " " + file;
  out += fmt::format(
      "\nnext:\n"
      "  cd {0}\n"
      "  cmake -S . -B build -DCMAKE_PREFIX_PATH=<where Dismantle is installed> && cmake --build build\n"
      "  ctest --test-dir build\n"
      "  DISMANTLE_PLUGIN_PATH=$PWD/build dismantle plugins describe {1}\n",
      options.folder, options.id);
  Console(ConsoleOptions{}).text(out);
  return kComplete;
}

}  // namespace

void add_plugins(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "plugins", "The simulators, planners and importers: list, describe, check, and begin new ones");
  command->require_subcommand(1);
  command->footer(
      "Plugins are found in the install's plugin folder, in $DISMANTLE_PLUGIN_PATH and in the search paths of the\n"
      "configuration.\n"
      "Examples:\n"
      "  dismantle plugins list\n"
      "  dismantle plugins describe bfs\n"
      "  dismantle plugins new my_planner --kind path_planner --name acme.rrt");
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

  struct Checked {
    std::vector<std::string> plugins;
    std::string examples;
    bool verbose = false;
  };
  auto checked = std::make_shared<Checked>();
  auto* check_command = command->add_subcommand("check", "Do plugins obey the laws of their kind?");
  check_command->add_option("FILE", checked->plugins, "Plugin files (.so), or ids as in 'plugins list'")
      ->required()
      ->option_text(" ");
  check_command
      ->add_option("--examples", checked->examples,
                   "Files that importers are tried on; beside NAME.xyz a folder NAME with an OBJ file for each part")
      ->option_text("DIR");
  check_command->add_flag("-v,--verbose", checked->verbose, "Names each law that is tried");
  check_command->footer(
      "Tries the contract tests on all types of these plugins, with partners from the plugins that are found.\n"
      "Exit status: 0 all laws hold, 1 some do not, 2 a plugin is refused.\n"
      "Example:\n  dismantle plugins check build/libacme_rrt.so");
  check_command->callback([&action, checked] {
    action = [checked]() -> int { check_plugins(checked->plugins, checked->examples, checked->verbose); };
  });

  auto made = std::make_shared<NewPlugin>();
  auto* new_command = command->add_subcommand("new", "Write a project for a plugin of your own");
  new_command->add_option("DIR", made->folder, "Folder for the project, new or empty")->required()->option_text(" ");
  new_command->add_option("--kind", made->kind, fmt::format("{}", fmt::join(template_kinds(), ", ")))
      ->required()
      ->option_text("KIND");
  new_command->add_option("--name", made->id, "Its id, with a dot: words of lower-case letters, digits and '_'")
      ->required()
      ->option_text("acme.rrt");
  new_command->footer(
      "Writes a complete project: CMake files, a plugin that works, its tests, a README, a workflow for GitHub and,\n"
      "where planners can be compared, a benchmark. It needs an installed Dismantle and nothing of its source\n"
      "(docs/write-a-planner.md).\n"
      "Example:\n  dismantle plugins new my_planner --kind path_planner --name acme.rrt");
  new_command->callback([&action, made] { action = [made] { return make_new(*made); }; });
}

}  // namespace dismantle::app
