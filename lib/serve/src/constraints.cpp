#include "constraints.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <functional>

#include "dismantle/errors.h"

namespace dismantle::serve {
namespace {

using Json = nlohmann::json;

constexpr const char* kLists[] = {"base", "ignore", "flexible"};

void each_name(const Json& names, const std::string& key, const std::function<void(const std::string&)>& visit) {
  if (!names.is_array()) throw Error(fmt::format("'{}' must be a list", key));
  for (const Json& name : names) {
    if (!name.is_string()) throw Error(fmt::format("'{}' must hold names of parts", key));
    visit(name.get<std::string>());
  }
}

void emit_names(YAML::Emitter& out, const std::string& key, const Json& names, const std::set<std::string>& parts) {
  out << YAML::Flow << YAML::BeginSeq;
  each_name(names, key, [&](const std::string& name) {
    if (!parts.contains(name)) throw Error(fmt::format("'{}': there is no part '{}'", key, name));
    out << YAML::DoubleQuoted << name;
  });
  out << YAML::EndSeq;
}

/// Forced steps that are accepted: [{"part", "against", "as", "depth"}].
void emit_accepted(YAML::Emitter& out, const Json& list, const std::set<std::string>& parts) {
  if (!list.is_array()) throw Error("'accept' must be a list");
  out << YAML::BeginSeq;
  for (const Json& item : list) {
    if (!item.is_object() || item.size() != 4) throw Error("'accept' must hold part, against, as and depth");
    const Json depth = item.value("depth", Json());
    if (!depth.is_number() || !(depth.get<double>() > 0)) throw Error("'accept': the depth must be above 0");
    out << YAML::Flow << YAML::BeginMap;
    for (const char* key : {"part", "against", "as"}) {
      const Json text = item.value(key, Json());
      if (!text.is_string()) throw Error(fmt::format("'accept': '{}' must be a text", key));
      const std::string word = text.get<std::string>();
      if (key != std::string("as") && !parts.contains(word))
        throw Error(fmt::format("'accept': there is no part '{}'", word));
      out << YAML::Key << key << YAML::Value << YAML::DoubleQuoted << word;
    }
    out << YAML::Key << "depth" << YAML::Value << fmt::format("{}", depth.get<double>()) << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

/// Keys with something in them. @throws Error for unknown ones.
Json used(const Json& constraints) {
  if (!constraints.is_object()) throw Error("constraints must be an object");
  const std::set<std::string> known{"base", "ignore", "flexible", "together", "target", "accept"};
  Json out = Json::object();
  for (const auto& [key, value] : constraints.items()) {
    if (!known.contains(key)) throw Error(fmt::format("unknown constraint '{}'", key));
    if (!value.empty() && value != "") out[key] = value;
  }
  return out;
}

}  // namespace

std::string constraints_yaml(const Json& constraints, const std::set<std::string>& parts, const std::string& extends) {
  const Json given = used(constraints);
  if (given.empty()) return "";
  YAML::Emitter out;
  out << YAML::Comment(
             "Written by 'dismantle serve' when parts are marked in the page. Settings of your own belong into "
             "NAME.yaml.")
      << YAML::BeginMap << YAML::Key << "schema" << YAML::Value << 1;
  if (!extends.empty()) out << YAML::Key << "extends" << YAML::Value << YAML::DoubleQuoted << extends;
  out << YAML::Key << "constraints" << YAML::Value << YAML::BeginMap;
  for (const char* key : kLists) {
    if (!given.contains(key)) continue;
    out << YAML::Key << key << YAML::Value;
    emit_names(out, key, given[key], parts);
  }
  if (given.contains("together")) {
    if (!given["together"].is_array()) throw Error("'together' must be a list of lists");
    out << YAML::Key << "together" << YAML::Value << YAML::BeginSeq;
    for (const Json& group : given["together"]) emit_names(out, "together", group, parts);
    out << YAML::EndSeq;
  }
  if (given.contains("accept")) {
    out << YAML::Key << "accept" << YAML::Value;
    emit_accepted(out, given["accept"], parts);
  }
  if (given.contains("target")) {
    if (!given["target"].is_string() || !parts.contains(given["target"].get<std::string>()))
      throw Error("'target' must be the name of a part");
    out << YAML::Key << "target" << YAML::Value << YAML::DoubleQuoted << given["target"].get<std::string>();
  }
  out << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

Json constraints_in(const std::string& yaml) {
  Json out = Json::object();
  try {
    const YAML::Node constraints = YAML::Load(yaml)["constraints"];
    if (!constraints) return out;
    for (const char* key : kLists)
      if (constraints[key]) out[key] = constraints[key].as<std::vector<std::string>>();
    if (constraints["together"]) out["together"] = constraints["together"].as<std::vector<std::vector<std::string>>>();
    if (constraints["accept"])
      for (const YAML::Node& item : constraints["accept"])
        out["accept"].push_back({{"part", item["part"].as<std::string>()},
                                 {"against", item["against"].as<std::string>()},
                                 {"as", item["as"].as<std::string>()},
                                 {"depth", item["depth"].as<double>()}});
    if (constraints["target"]) out["target"] = constraints["target"].as<std::string>();
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("the file of constraints cannot be read: {}", e.what()));
  }
  return out;
}

}  // namespace dismantle::serve
