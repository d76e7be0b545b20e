/// Options that set configuration keys, and objects that are made from a configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "console.h"
#include "dismantle/assembly.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/run_context.h"
#include "dismantle/session/session.h"

namespace dismantle::app {

/// -c, --set and options that each set one key.
class ConfigFlags {
 public:
  void add_file_and_set(CLI::App& command);
  /// `flag`: such as "--seed". Its value becomes that of `key` literally.
  CLI::Option* add_key(CLI::App& command, const std::string& flag, const std::string& key,
                       const std::string& value_name, const std::string& help);
  /// As add_key; each use of the flag adds its value to the list of `key`.
  void add_list_key(CLI::App& command, const std::string& flag, const std::string& key, const std::string& value_name,
                    const std::string& help);
  /// --components and --open.
  void add_components(CLI::App& command);
  ConfigSource source() const;

 private:
  struct Key {
    CLI::Option* option;
    std::string flag, key;
    std::unique_ptr<std::string> value;  // allocated, because the parser keeps its address
  };
  struct ListKey {
    std::string flag, key;
    std::unique_ptr<std::vector<std::string>> values;
  };
  std::string file_;
  std::vector<std::string> set_;
  std::vector<Key> keys_;
  std::vector<ListKey> list_keys_;
};

/// Warns of each plugin file that cannot be used.
void warn_of_problems(const Registry& registry, Console& console);
/// The same, and of keys of the configuration that should be written otherwise.
void warn_of_problems(const Session& session, Console& console);

/// A context of the session that signals cancel and whose messages go to `console`.
RunContext context_of(const Session& session, Console& console);

/// A session that reads plans. Warnings about plugins go to `console`.
Session reader(Console& console);

/// Creates the folder if needed and checks that files can be written there, before any work is done.
/// @throws Error naming the folder.
void open_output_folder(const std::filesystem::path& folder);

}  // namespace dismantle::app
