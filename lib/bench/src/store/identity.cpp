#include "store/identity.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace dismantle::bench {
namespace {

/// The values of a resolved configuration by the path of their key.
std::map<std::string, std::string> values_of(const std::string& text) {
  std::map<std::string, std::string> out;
  std::vector<std::pair<std::size_t, std::string>> keys;  // indentation, name
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos) continue;
    std::string content = line.substr(indent);
    while (!keys.empty() && keys.back().first >= indent) keys.pop_back();
    std::string path;
    for (const auto& key : keys) path += key.second + ".";
    if (content.starts_with("# plugin ")) {
      out[path + "plugin"] += content.substr(9);
      continue;
    }
    if (const std::size_t comment = content.find(" #"); comment != std::string::npos) content.resize(comment);
    while (!content.empty() && content.back() == ' ') content.pop_back();
    if (content.empty() || content.front() == '#') continue;
    const std::size_t colon = content.find(':');
    const std::string name = content.substr(0, colon);
    const std::size_t begin = colon == std::string::npos ? colon : content.find_first_not_of(' ', colon + 1);
    keys.emplace_back(indent, name);
    out[path + name] += begin == std::string::npos ? "" : content.substr(begin);
  }
  return out;
}

}  // namespace

std::string shared_difference(const TrialPlan& a, const TrialPlan& b) {
  if (a.limit_path_timeout != b.limit_path_timeout) return "limits.path_timeout";
  if (a.limit_path_steps != b.limit_path_steps) return "limits.path_steps";
  if (a.limit_timeout != b.limit_timeout) return "limits.timeout";
  if (a.limit_wall != b.limit_wall) return "limits.wall";
  if (a.limit_cpu != b.limit_cpu) return "limits.cpu";
  if (a.limit_memory_mb != b.limit_memory_mb) return "limits.memory";
  if (a.threads != b.threads) return "limits.threads";
  if (a.part != b.part) return "the part";
  if (a.verify_max_penetration != b.verify_max_penetration) return "verify.max_penetration";
  return {};
}

std::string changed_values(const std::string& before, const std::string& now) {
  constexpr std::size_t kShown = 4;
  const auto old_values = values_of(before), new_values = values_of(now);
  std::set<std::string> keys;
  for (const auto& entry : old_values) keys.insert(entry.first);
  for (const auto& entry : new_values) keys.insert(entry.first);
  std::string out;
  std::size_t n = 0;
  const auto value = [](const auto& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("none") : found->second;
  };
  for (const auto& key : keys) {
    if (key == "run.seed" || key.starts_with("plugins.")) continue;  // folders of plugins change nothing by themselves
    const std::string was = value(old_values, key), is = value(new_values, key);
    if (was == is || ++n > kShown) continue;
    out += fmt::format("{}{}: {} -> {}", out.empty() ? "" : "; ", key, was, is);
  }
  return n > kShown ? out + fmt::format("; and {} more", n - kShown) : out;
}

}  // namespace dismantle::bench
