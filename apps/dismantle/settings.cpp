#include "dismantle/settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <thread>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/host/planning_setup.h"
#include "dismantle/host/suggest.h"
#include "dismantle/interrupt.h"
#include "dismantle/preparation/flexible_parts.h"
#include "dismantle/stopped.h"

namespace dismantle::app {

void ConfigFlags::add_file_and_set(CLI::App& command) {
  command.add_option("-c,--config", file_, "Configuration (docs/configuration.md)")->option_text("CONFIG.yaml");
  command.add_option("--set", set_, "Override one key, as in path_planner.max_depth=3; may be repeated")
      ->option_text("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

void ConfigFlags::add_key(CLI::App& command, const std::string& flag, const std::string& key,
                          const std::string& value_name, const std::string& help) {
  keys_.push_back({nullptr, flag, key, std::make_unique<std::string>()});
  keys_.back().option =
      command.add_option(flag, *keys_.back().value, fmt::format("{} ({})", help, key))->option_text(value_name);
}

ConfigSource ConfigFlags::source() const {
  ConfigSource source;
  if (!file_.empty()) source.file = file_;
  source.set = set_;
  for (const Key& key : keys_)
    if (key.option->count() > 0) source.options.push_back({key.flag, key.key, *key.value});
  return source;
}

void warn_of_problems(const Registry& registry, Console& console) {
  for (const auto& problem : registry.problems())
    console.warning(fmt::format("plugin not used: {}: {}", problem.file.string(), problem.message));
}

RunContext context_of(const RunSettings& settings, Console& console) {
  RunContext context;
  if (settings.timeout > 0) context.deadline = Deadline::after_seconds(settings.timeout);
  context.threads = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  if (context.threads > 1) context.executor = std::make_shared<Executor>(context.threads);
  console.attach(context);
  cancel_on_signals(context.cancel);
  return context;
}

namespace {

std::vector<std::string> names_of(const std::vector<RawPart>& parts) {
  std::vector<std::string> names;
  for (const auto& raw : parts) names.push_back(raw.name);
  return names;
}

void check_part(const std::string& part, const std::vector<RawPart>& parts, const std::string& input) {
  const std::vector<std::string> names = names_of(parts);
  for (const auto& raw : parts)
    if (raw.name == part && !raw.problem.empty())
      throw InputError(input, fmt::format("part '{}' cannot be used: {}", part, raw.problem));
  if (part.empty() || std::find(names.begin(), names.end(), part) != names.end()) return;
  std::string text = fmt::format("has no part '{}'", part);
  if (const auto near = nearest(part, names)) {
    text += fmt::format("; did you mean '{}'?", *near);
  } else {
    text += "; its parts:";
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 20); ++i)
      text += fmt::format("{} '{}'", i ? "," : "", names[i]);
    if (names.size() > 20) text += fmt::format(" and {} more", names.size() - 20);
  }
  throw InputError(input, text);
}

}  // namespace

Assembly load_assembly(const std::string& input, const RunConfig& config, const Registry& registry, RunContext& context,
                       PrepareReport& report, const std::string& part) {
  ReadOptions options;
  options.max_triangles = config.assembly.max_triangles;
  return stoppable(context, [&] {
    const ImportParams import_params = import_params_of(config, registry);
    InputParts parts = read_input(input, importers_of(registry, import_params), options, context);
    for (const auto& warning : parts.warnings) context.log(LogLevel::warning, warning);
    for (const auto& note : parts.notes) context.log(LogLevel::info, note);
    check_part(part, parts.parts, input);
    check_constraint_names(config, names_of(parts.parts), input);
    const auto& ignore = config.constraints.ignore;
    std::vector<ExcludedPart> ignored;
    for (const auto& raw : parts.parts)
      if (std::find(ignore.begin(), ignore.end(), raw.name) != ignore.end())
        ignored.push_back({raw.name, "the configuration says to ignore it (constraints.ignore)", true});
    std::erase_if(parts.parts,
                  [&](const auto& raw) { return std::find(ignore.begin(), ignore.end(), raw.name) != ignore.end(); });
    Assembly assembly = [&] {
      try {
        return prepare_assembly(std::move(parts.parts), input, parts.sha256, config.assembly, context, report);
      } catch (const InputError&) {
        add_findings(parts, report);
        throw;
      }
    }();
    add_findings(parts, report);
    assembly.import_params = import_params;
    declare_overlaps(config.constraints, assembly);
    report.flexible = with_declared(std::move(report.flexible), config.constraints.flexible, assembly);
    assembly.excluded.insert(assembly.excluded.end(), ignored.begin(), ignored.end());
    return assembly;
  });
}

std::vector<std::string> unusable_parts(const Assembly& assembly) {
  std::vector<std::string> names;
  for (const auto& part : assembly.excluded)
    if (!part.by_choice) names.push_back(part.name);
  return names;
}

void open_output_folder(const std::filesystem::path& folder) {
  const auto fail = [&](const std::string& why) {
    throw Error(fmt::format("{}: cannot be used as output folder: {}", folder.string(), why));
  };
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(error.message());
  if (!std::filesystem::is_directory(folder, error)) fail("it is not a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(std::generic_category().message(errno));
}

}  // namespace dismantle::app
