/// One plugin file: from path to what it offers, and on to registered types, or a reason why not.
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

/// What a file says that it registers, before any of its code runs.
struct OfferedType {
  PluginKind kind = PluginKind::simulator;
  std::string id;
  bool operator==(const OfferedType&) const = default;
};

struct OfferedPlugin {
  PluginFile file;
  std::vector<OfferedType> types;  ///< empty: it does not say
};

struct LoadedPlugin {
  PluginFile file;
  std::vector<PluginType> types;
};

/// Handshake on the bytes alone. `file` is canonical. @throws PluginRefused
OfferedPlugin read_plugin(const std::filesystem::path& file, bool built_in);

/// dlopen (never closed), registration and the checks of what was registered: all that was offered, if it was said.
/// @throws PluginRefused
LoadedPlugin load_plugin(const OfferedPlugin& offered);

/// The kind and id of each type, in order.
std::vector<OfferedType> offers_of(const std::vector<PluginType>& types);

/// Everything wrong with the types of one file: bad ids, missing docs, defaults out of range, an id twice.
std::vector<std::string> problems_of_types(const std::vector<PluginType>& types, bool built_in);

}  // namespace dismantle
