/// One plugin file: from path to registered types, or a reason why not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle {

/// A refusal that knows what was in the file as far as it got.
struct PluginRefused {
  PluginProblem problem;
};

struct LoadedPlugin {
  PluginFile file;
  std::vector<PluginType> types;
};

/// Handshake on the bytes, then dlopen (never closed), registration and the checks of what was registered.
/// `file` is canonical. @throws PluginRefused
LoadedPlugin load_plugin(const std::filesystem::path& file, bool built_in);

/// Everything wrong with the types of one file: bad ids, missing docs, defaults out of range, an id twice.
std::vector<std::string> problems_of_types(const std::vector<PluginType>& types, bool built_in);

}  // namespace dismantle
