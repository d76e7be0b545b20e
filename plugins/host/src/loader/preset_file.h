/// A preset file: `schema`, `summary`, and the choice under the key of its kind.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/host/config_node.h"
#include "dismantle/plugin_kind.h"

namespace dismantle {

struct PresetFile {
  std::filesystem::path file;
  PluginKind kind = PluginKind::path_planner;
  std::string id;  ///< name of the file
  std::string summary;
  ConfigNode choice;                 ///< a map with a type
  std::vector<Diagnostic> problems;  ///< not empty: the preset cannot be used
};

/// Reads `folder`/<kind>/<id>.yaml, sorted by kind and name.
std::vector<std::unique_ptr<PresetFile>> read_presets(const std::filesystem::path& folder);

}  // namespace dismantle
