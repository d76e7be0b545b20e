/// Loads one plugin file in two steps: its list of types, then the registered types; or a reason for the refusal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle {

/// A refusal, with all that was known about the file at that point.
struct PluginRefused {
  PluginProblem problem;
};

/// A type that a file lists, read before any of its code runs.
struct OfferedType {
  PluginKind kind = PluginKind::simulator;
  std::string id;
  bool operator==(const OfferedType&) const = default;
};

struct OfferedPlugin {
  PluginFile file;
  std::vector<OfferedType> types;  ///< empty: the file has no list
};

struct LoadedPlugin {
  PluginFile file;
  std::vector<PluginType> types;
};

/// Handshake on the file's bytes, without loading it. `file` must be canonical. @throws PluginRefused
OfferedPlugin read_plugin(const std::filesystem::path& file, bool built_in);

/// Calls dlopen (never closed), registers the types and checks them. A file with a list must register exactly its
/// types.
/// @throws PluginRefused
LoadedPlugin load_plugin(const OfferedPlugin& offered);

/// The kind and id of each type, in order.
std::vector<OfferedType> offers_of(const std::vector<PluginType>& types);

/// All problems of the types of one file: bad ids, missing docs, defaults out of range, repeated ids.
std::vector<std::string> problems_of_types(const std::vector<PluginType>& types, bool built_in);

}  // namespace dismantle
