#include "config/constraints.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/layers.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"

namespace dismantle {
namespace {

bool is_name(const ConfigNode& node) { return node.is_scalar() && !node.scalar.empty(); }

/// A list of names; `least` of them at least.
std::vector<std::string> names(const std::string& key, const ConfigNode& list, std::size_t least,
                               std::vector<Diagnostic>& problems) {
  std::vector<std::string> out;
  const bool good = list.kind == ConfigNode::Kind::sequence && list.items.size() >= least &&
                    std::all_of(list.items.begin(), list.items.end(), is_name);
  if (!good) {
    problems.push_back(list.mark.error(
        fmt::format("constraints.{} must be a list of {} names of parts", key, least == 2 ? "two or more" : "")));
    return out;
  }
  for (const auto& item : list.items) out.push_back(item.scalar);
  return out;
}

/// A list of lists of two names or more.
std::vector<std::vector<std::string>> lists(const std::string& key, const ConfigNode& list,
                                            std::vector<Diagnostic>& problems) {
  std::vector<std::vector<std::string>> out;
  if (list.kind != ConfigNode::Kind::sequence) {
    problems.push_back(list.mark.error(
        fmt::format("constraints.{} must be a list of lists of names of parts, not {}", key, list.kind_name())));
    return out;
  }
  for (const auto& item : list.items) out.push_back(names(key, item, 2, problems));
  return out;
}

}  // namespace

const std::vector<std::string>& constraint_keys() {
  static const std::vector<std::string> keys{"base", "together", "before", "target", "ignore"};
  return keys;
}

NamedConstraints read_constraints(const ConfigNode& section, std::vector<Diagnostic>& problems) {
  NamedConstraints out;
  if (!section.is_map()) {
    problems.push_back(
        section.mark.error(fmt::format("constraints must be a map of keys, not {}", section.kind_name())));
    return out;
  }
  for (const auto& [key, key_mark, value] : section.members) {
    if (key == "base") {
      out.base = names(key, value, 0, problems);
    } else if (key == "ignore") {
      out.ignore = names(key, value, 0, problems);
    } else if (key == "together") {
      out.together = lists(key, value, problems);
    } else if (key == "before") {
      out.before = lists(key, value, problems);
    } else if (key == "target") {
      if (is_name(value))
        out.target = value.scalar;
      else
        problems.push_back(value.mark.error("constraints.target must be the name of a part"));
    } else {
      problems.push_back(
          key_mark.error(unknown_key_message(key, {"constraints", "", ""}, constraint_keys(), KeyHomes{})));
    }
  }
  return out;
}

Constraints constraints_of(const NamedConstraints& named, const Assembly& assembly) {
  const auto id = [&](const std::string& name) {
    for (const auto& part : assembly.parts)
      if (part.name == name) return part.id;
    std::string known;
    for (const auto& part : assembly.parts) known += (known.empty() ? "'" : ", '") + part.name + "'";
    throw InputError(assembly.source,
                     fmt::format("constraints name the part '{}', which is not there; its parts are {}", name, known));
  };
  const auto ids = [&](const std::vector<std::string>& list) {
    std::vector<PartId> out;
    for (const auto& name : list) out.push_back(id(name));
    return out;
  };
  Constraints out;
  out.base = ids(named.base);
  for (const auto& list : named.together) out.together.push_back(ids(list));
  for (const auto& list : named.before)
    for (std::size_t k = 1; k < list.size(); ++k) out.before.emplace_back(id(list[k - 1]), id(list[k]));
  if (!named.target.empty()) out.target = id(named.target);
  return out;
}

}  // namespace dismantle
