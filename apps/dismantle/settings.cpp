#include "settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <memory>
#include <system_error>

#include "dismantle/errors.h"
#include "interrupt.h"

namespace dismantle::app {

void ConfigFlags::add_file_and_set(CLI::App& command) {
  command.add_option("-c,--config", file_, "Configuration (docs/configuration.md)")->option_text("CONFIG.yaml");
  command.add_option("--set", set_, "Override one key, as in path_planner.max_depth=3; may be repeated")
      ->option_text("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

CLI::Option* ConfigFlags::add_key(CLI::App& command, const std::string& flag, const std::string& key,
                                  const std::string& value_name, const std::string& help) {
  keys_.push_back({nullptr, flag, key, std::make_unique<std::string>()});
  keys_.back().option =
      command.add_option(flag, *keys_.back().value, fmt::format("{} ({})", help, key))->option_text(value_name);
  return keys_.back().option;
}

void ConfigFlags::add_list_key(CLI::App& command, const std::string& flag, const std::string& key,
                               const std::string& value_name, const std::string& help) {
  list_keys_.push_back({flag, key, std::make_unique<std::vector<std::string>>()});
  command.add_option(flag, *list_keys_.back().values, fmt::format("{} ({})", help, key))
      ->option_text(value_name)
      ->take_all()
      ->allow_extra_args(false);
}

void ConfigFlags::add_components(CLI::App& command) {
  add_key(command, "--components", "components.level", "keep|open",
          "Put in a product of several bodies as one, or open all of them")
      ->transform(CLI::CheckedTransformer(std::map<std::string, std::string>{{"keep", "component"}, {"open", "solid"}})
                      .description(""));
  add_list_key(command, "--open", "components.apart", "NAME",
               "Plan the bodies of this product one by one; may be repeated");
}

ConfigSource ConfigFlags::source() const {
  ConfigSource source;
  if (!file_.empty()) source.file = file_;
  source.set = set_;
  for (const Key& key : keys_)
    if (key.option->count() > 0) source.options.push_back({key.flag, key.key, *key.value});
  for (const ListKey& key : list_keys_)
    for (const std::string& value : *key.values) source.options.push_back({key.flag, key.key, value, true});
  return source;
}

void warn_of_problems(const Registry& registry, Console& console) {
  for (const auto& problem : registry.problems())
    console.warning(fmt::format("plugin not used: {}: {}", problem.file.string(), problem.message));
}

void warn_of_problems(const Session& session, Console& console) {
  for (const auto& warning : session.config().warnings) console.warning(warning);
  warn_of_problems(session.registry(), console);
}

RunContext context_of(const Session& session, Console& console) {
  RunContext context = session.context();
  console.attach(context);
  cancel_on_signals(context.cancel);
  return context;
}

Session reader(Console& console) {
  Session session = Session::reader();
  warn_of_problems(session.registry(), console);
  return session;
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
