#include "dismantle/host/config_node.h"
#include "dismantle/session/session.h"

namespace dismantle {
namespace {

void flatten(const ConfigNode& node, const std::string& key, ExplainSettings& out) {
  if (node.is_scalar()) out[key] = node.scalar;
  for (const auto& member : node.members) flatten(member.value, key.empty() ? member.key : key + "." + member.key, out);
}

}  // namespace

ExplainSettings settings_beside(const std::filesystem::path& plan) {
  ExplainSettings out;
  const std::filesystem::path file = std::filesystem::path(plan).replace_filename("resolved.yaml");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return out;
  std::vector<Diagnostic> problems;
  std::string unreadable;
  ConfigNode root;
  if (read_yaml(file.string(), root, problems, unreadable) && problems.empty()) flatten(root, "", out);
  return out;
}

}  // namespace dismantle
