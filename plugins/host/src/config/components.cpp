#include "config/components.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "config/yaml_writer.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"
#include "dismantle/preparation/name_pattern.h"

namespace dismantle {
namespace {

const std::vector<std::string>& component_keys() {
  static const std::vector<std::string> keys{"level", "together", "apart"};
  return keys;
}

void read_level(const ConfigNode& node, ComponentChoice& out, std::vector<Diagnostic>& problems) {
  const std::string& text = node.scalar;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.depth);
  if (node.is_scalar() && text == "component")
    out.level = ComponentChoice::Level::component;
  else if (node.is_scalar() && text == "solid")
    out.level = ComponentChoice::Level::solid;
  else if (node.is_scalar() && error == std::errc{} && end == text.data() + text.size() && out.depth > 0)
    out.level = ComponentChoice::Level::depth;
  else
    problems.push_back(node.mark.error(
        "components.level must be component, solid, or a depth in the product tree (1 or more; the root is 0)"));
}

}  // namespace

ComponentChoice read_components(const ConfigNode& section, std::vector<ConstraintName>& places,
                                std::vector<Diagnostic>& problems) {
  ComponentChoice out;
  if (!section.is_map()) {
    problems.push_back(section.mark.error(fmt::format("components must be a map of keys, not {}", section.kind_name())));
    return out;
  }
  const auto is_name = [](const ConfigNode& n) { return n.is_scalar() && !n.scalar.empty(); };
  for (const auto& [key, key_mark, value] : section.members) {
    if (key == "level") {
      read_level(value, out, problems);
    } else if (key == "together" || key == "apart") {
      if (value.kind != ConfigNode::Kind::sequence || !std::ranges::all_of(value.items, is_name)) {
        problems.push_back(
            value.mark.error(fmt::format("components.{} must be a list of names of products ('*' and '?' match)", key)));
        continue;
      }
      for (const ConfigNode& item : value.items) {
        (key == "apart" ? out.apart : out.together).push_back(item.scalar);
        places.push_back({key, item.scalar, item.mark.error("")});
      }
    } else {
      problems.push_back(
          key_mark.error(unknown_key_message(key, {"components", "", ""}, component_keys(), KeyHomes{})));
    }
  }
  return out;
}

std::vector<std::string> component_lines(const ComponentChoice& choice) {
  if (choice == ComponentChoice{}) return {};
  std::vector<std::string> out{"components:"};
  if (choice.level)
    out.push_back("  level: " + (*choice.level == ComponentChoice::Level::component ? "component"
                                 : *choice.level == ComponentChoice::Level::solid   ? "solid"
                                                                                    : std::to_string(choice.depth)));
  for (const auto& [key, names] : {std::pair("together", &choice.together), std::pair("apart", &choice.apart)}) {
    std::string list;
    for (const std::string& name : *names) list += (list.empty() ? "" : ", ") + quoted(name);
    if (!names->empty()) out.push_back(fmt::format("  {}: [{}]", key, list));
  }
  return out;
}

void check_component_names(const RunConfig& config, const std::vector<std::string>& products,
                           const std::string& input) {
  std::vector<Diagnostic> problems;
  for (const auto& [key, pattern, place] : config.component_names) {
    if (std::ranges::any_of(products, [&](const std::string& p) { return name_matches(p, pattern); })) continue;
    problems.push_back(place);
    std::string& message = problems.back().message;
    message = fmt::format("components.{}: {} has no product '{}'", key, input, pattern);
    if (const auto near = nearest(pattern, products))
      message += fmt::format("; did you mean '{}'?", *near);
    else if (products.empty())
      message += "; its format has no products";
    else if (products.size() <= 20)
      message += fmt::format("; its products: '{}'", fmt::join(products, "', '"));
  }
  if (problems.empty()) return;
  sort_by_place(problems);
  throw ConfigError(std::move(problems));
}

}  // namespace dismantle
