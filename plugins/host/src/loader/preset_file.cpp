#include "loader/preset_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/layers.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/registry.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<PresetFile> read_preset(const fs::path& file, PluginKind kind) {
  auto preset = std::make_unique<PresetFile>();
  preset->file = file;
  preset->kind = kind;
  preset->id = file.stem().string();
  auto& problems = preset->problems;
  ConfigNode root;
  std::string unreadable;
  if (!read_yaml(file.string(), root, problems, unreadable)) {
    problems.push_back({"", 0, 0, unreadable});
    return preset;
  }
  if (!root.is_map()) {
    problems.push_back(root.mark.error(fmt::format("a preset must be a map of keys, not {}", root.kind_name())));
    return preset;
  }
  take_schema(root, problems);
  const std::string key(to_string(kind));
  for (const auto& member : root.members)
    if (member.key != "summary" && member.key != key)
      problems.push_back(
          member.key_mark.error(unknown_key_message(member.key, {"a preset", "", ""}, {"summary", key}, {})));
  if (const auto* summary = root.find("summary"); summary != nullptr && summary->value.is_scalar())
    preset->summary = summary->value.scalar;
  if (preset->summary.empty()) problems.push_back(root.mark.error("a preset needs the key 'summary', one line"));
  if (const auto* choice = root.find(key); choice != nullptr && choice->value.is_map()) preset->choice = choice->value;
  if (named_type(preset->choice).empty())
    problems.push_back(root.mark.error(fmt::format("a preset needs the key '{0}', as '{0}: {{type: ID, ...}}'", key)));
  return preset;
}

}  // namespace

std::vector<std::unique_ptr<PresetFile>> read_presets(const fs::path& folder) {
  std::vector<std::unique_ptr<PresetFile>> presets;
  for (const PluginKind kind : kPluginKinds) {
    std::vector<fs::path> files;
    std::error_code error;
    fs::directory_iterator it(folder / to_string(kind), error);
    for (; !error && it != fs::directory_iterator(); it.increment(error))
      if (it->path().extension() == ".yaml") files.push_back(it->path());
    std::sort(files.begin(), files.end());  // the directory order differs between machines
    for (const auto& file : files) presets.push_back(read_preset(file, kind));
  }
  return presets;
}

}  // namespace dismantle
