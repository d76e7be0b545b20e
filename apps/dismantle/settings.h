/// Options that set configuration keys, and objects that are made from a configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/console.h"
#include "dismantle/importer.h"
#include "dismantle/assembly.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/host/registry.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

/// -c, --set and options that each set one key.
class ConfigFlags {
 public:
  void add_file_and_set(CLI::App& command);
  /// `flag`: such as "--seed". Its value becomes that of `key` literally.
  void add_key(CLI::App& command, const std::string& flag, const std::string& key, const std::string& value_name,
               const std::string& help);
  ConfigSource source() const;

 private:
  struct Key {
    CLI::Option* option;
    std::string flag, key;
    std::unique_ptr<std::string> value;  // allocated, because the parser keeps its address
  };
  std::string file_;
  std::vector<std::string> set_;
  std::vector<Key> keys_;
};

/// Warns of each plugin file that cannot be used.
void warn_of_problems(const Registry& registry, Console& console);

/// A context with threads, deadline and cancellation by signals, whose messages go to `console`.
RunContext context_of(const RunSettings& settings, Console& console);

/// Reads and prepares `input`. Warnings go to the context's log. `part`: a part that must exist, else InputError before
/// preparation begins; empty: none.
Assembly load_assembly(const std::string& input, const RunConfig& config, const Registry& registry, RunContext& context,
                       PrepareReport& report, const std::string& part = {});

/// Names of parts that could not be used, without those that the configuration excludes.
std::vector<std::string> unusable_parts(const Assembly& assembly);

/// Creates the folder if needed and checks that files can be written there, before any work is done.
/// @throws Error naming the folder.
void open_output_folder(const std::filesystem::path& folder);

}  // namespace dismantle::app
