#include "config/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "config/config_limits.h"
#include "config/list_items.h"
#include "dismantle/host/config_bind.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

/// True if `over` chooses another plugin than `base`, the map below it.
bool changes_type(const ConfigNode& base, const ConfigNode& over) {
  const std::string below = named_type(base), above = named_type(over);
  return !below.empty() && !above.empty() && below != above;
}

void merge_nodes(ConfigNode& base, ConfigMember over, const std::string& path, std::vector<Diagnostic>& problems);

void merge_maps(ConfigNode& base, ConfigNode over, const std::string& path, std::vector<Diagnostic>& problems) {
  for (auto& member : over.members) {
    auto* below = base.find(member.key);
    if (below == nullptr) {
      base.members.push_back(std::move(member));
      continue;
    }
    if (!below->value.is_map() || !member.value.is_map()) below->key_mark = member.key_mark;
    merge_nodes(below->value, std::move(member), path.empty() ? below->key : path + "." + below->key, problems);
  }
}

void merge_items(ConfigNode& list, ConfigNode over, const std::string& path, std::vector<Diagnostic>& problems) {
  std::vector<std::string> types;
  for (const ConfigNode& item : list.items) types.push_back(named_type(item));
  for (auto& member : over.members) {
    const auto index = item_index(member.key, types);
    if (!index) {
      problems.push_back(member.key_mark.error(no_item_message(path, member.key, types)));
      continue;
    }
    ConfigNode& item = list.items[*index];
    if (item.is_scalar() && member.value.is_map()) {  // `ID` stands for {type: ID}
      ConfigNode map;
      map.kind = ConfigNode::Kind::map;
      map.mark = item.mark;
      map.members.push_back({"type", item.mark, item});
      item = std::move(map);
    }
    merge_nodes(item, std::move(member), fmt::format("{}.{}", path, *index), problems);
  }
}

/// Merges one value into the value below it.
void merge_nodes(ConfigNode& base, ConfigMember over, const std::string& path, std::vector<Diagnostic>& problems) {
  if (base.is_map() && over.value.is_map() && !changes_type(base, over.value))
    merge_maps(base, std::move(over.value), path, problems);
  else if (base.kind == ConfigNode::Kind::sequence && over.value.is_map())
    merge_items(base, std::move(over.value), path, problems);
  else
    base = std::move(over.value);
}

class FileChain {
 public:
  explicit FileChain(std::vector<Diagnostic>& problems) : problems_(problems) {}

  /// Loads a file, merged over the files that it extends. `from`: the place that names it; nullptr if no file does.
  ConfigNode load(const std::string& shown, const ConfigMark* from) {
    std::error_code error;
    fs::path identity = fs::weakly_canonical(shown, error);
    if (error) identity = shown;
    const auto again = std::find(chain_.begin(), chain_.end(), identity);
    if (from != nullptr && (again != chain_.end() || chain_.size() >= kConfigLimits.files)) {
      problems_.push_back(from->error(again != chain_.end()
                                          ? fmt::format("'{}' extends itself{}", shown, chain_from(again))
                                          : fmt::format("more than {} files extend each other", kConfigLimits.files)));
      return empty();
    }
    ConfigNode root;
    std::string unreadable;
    if (!read_yaml(shown, root, problems_, unreadable)) {
      problems_.push_back(from != nullptr ? from->error(unreadable) : Diagnostic{"", 0, 0, unreadable});
      return empty();
    }
    if (root.cut_off) return empty();  // missing keys may be in the part that could not be read
    if (!root.is_map()) {
      problems_.push_back(
          root.mark.error(fmt::format("a configuration must be a map of keys, not {}", root.kind_name())));
      return empty();
    }
    take_schema(root, problems_);
    chain_.push_back(identity);
    names_.push_back(shown);
    ConfigNode result = extended(std::move(root), shown);
    chain_.pop_back();
    names_.pop_back();
    return result;
  }

 private:
  static ConfigNode empty() {
    ConfigNode node;
    node.kind = ConfigNode::Kind::map;
    return node;
  }

  ConfigNode extended(ConfigNode root, const std::string& shown) {
    const auto* extends = root.find("extends");
    if (extends == nullptr) return root;
    const ConfigNode value = extends->value;
    root.erase("extends");
    if (!value.is_scalar() || value.scalar.empty()) {
      problems_.push_back(value.mark.error("extends must be the name of a file"));
      return root;
    }
    const fs::path base_file = (fs::path(shown).parent_path() / value.scalar).lexically_normal();
    ConfigNode base = load(base_file.string(), &value.mark);
    if (base.mark.source == nullptr) base.mark = root.mark;
    merge_config(base, std::move(root), problems_);
    return base;
  }

  std::string chain_from(std::vector<fs::path>::const_iterator begin) const {
    const std::size_t first = static_cast<std::size_t>(begin - chain_.begin());
    if (first + 1 == names_.size()) return "";
    std::string text = ": ";
    for (std::size_t i = first; i < names_.size(); ++i) text += names_[i] + " -> ";
    return text + names_[first];
  }

  std::vector<Diagnostic>& problems_;
  std::vector<fs::path> chain_;
  std::vector<std::string> names_;
};

/// The tree of all --set values and options: dotted keys become nested maps.
class Overrides {
 public:
  explicit Overrides(std::vector<Diagnostic>& problems) : problems_(problems) { root_.kind = ConfigNode::Kind::map; }

  void set(const std::string& text, int number) {
    const ConfigMark mark{std::make_shared<const std::string>("<--set>"), number, 0};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      problems_.push_back(mark.error(fmt::format("'{}' is not of the form KEY=VALUE, such as run.seed=7", text)));
      return;
    }
    std::vector<Diagnostic> found;
    ConfigNode value = parse_yaml(text.substr(equals + 1), "<--set>", found);
    if (text.size() == equals + 1) value = {};
    remark(value, mark);
    for (const auto& problem : found) problems_.push_back(mark.error(problem.message));
    if (found.empty()) insert(text.substr(0, equals), std::move(value), mark);
  }

  void option(const ConfigOption& option) {
    const ConfigMark mark{std::make_shared<const std::string>("<" + option.flag + ">"), 0, 0};
    ConfigNode value;
    value.kind = ConfigNode::Kind::scalar;
    value.scalar = option.value;
    value.mark = mark;
    insert(option.key, std::move(value), mark);
  }

  ConfigNode take() { return std::move(root_); }

 private:
  static void remark(ConfigNode& node, const ConfigMark& mark) {
    node.mark = mark;
    for (auto& item : node.items) remark(item, mark);
    for (auto& member : node.members) {
      member.key_mark = mark;
      remark(member.value, mark);
    }
  }

  void insert(const std::string& key, ConfigNode value, const ConfigMark& mark) {
    if (key == "schema" || key == "extends") {
      problems_.push_back(mark.error(fmt::format("'{}' cannot be set: it belongs to a file", key)));
      return;
    }
    ConfigNode* at = &root_;
    std::size_t begin = 0;
    while (true) {
      const std::size_t dot = std::min(key.find('.', begin), key.size());
      const std::string word = key.substr(begin, dot - begin);
      const bool last = dot == key.size();
      if (word.empty()) {
        problems_.push_back(mark.error(fmt::format("'{}' is no key: a name is missing between its dots", key)));
        return;
      }
      auto* member = at->find(word);
      if (member != nullptr && (last || !member->value.is_map())) {
        problems_.push_back(
            mark.error(fmt::format("'{}' is set twice; it was set by {} already", key, member->key_mark.text())));
        return;
      }
      if (member == nullptr) {
        ConfigNode node;
        if (last) {
          node = std::move(value);
        } else {
          node.kind = ConfigNode::Kind::map;
          node.mark = mark;
        }
        at->members.push_back({word, mark, std::move(node)});
        member = &at->members.back();
      }
      if (last) return;
      at = &member->value;
      begin = dot + 1;
    }
  }

  std::vector<Diagnostic>& problems_;
  ConfigNode root_;
};

}  // namespace

std::string named_type(const ConfigNode& choice) {
  const ConfigMember* type = choice.is_map() ? choice.find("type") : nullptr;
  const ConfigNode& id = type != nullptr ? type->value : choice;
  return id.is_scalar() ? id.scalar : std::string();
}

void merge_config(ConfigNode& base, ConfigNode over, std::vector<Diagnostic>& problems) {
  for (const auto& section : plugin_sections()) {  // without a type, the default type applies
    if (section.one == nullptr) continue;
    const auto* below = base.find(section.name);
    const auto* above = over.find(section.name);
    if (below == nullptr || above == nullptr || !below->value.is_map() || !above->value.is_map()) continue;
    if (below->value.find("type") == nullptr && above->value.find("type") != nullptr &&
        named_type(above->value) != section.defaults.front())
      base.erase(section.name);
  }
  merge_maps(base, std::move(over), "", problems);
}

/// Adds to the list SECTION.KEY. What is no list stays: reading the section reports it.
static void add_to_list(ConfigNode& root, const ConfigOption& option) {
  const ConfigMark mark{std::make_shared<const std::string>("<" + option.flag + ">"), 0, 0};
  const auto below = [&](ConfigNode& map, const std::string& key, ConfigNode::Kind kind) {
    if (map.find(key) == nullptr) {
      ConfigNode fresh;
      fresh.kind = kind;
      fresh.mark = mark;
      map.members.push_back({key, mark, std::move(fresh)});
    }
    ConfigNode& value = map.find(key)->value;
    return value.kind == kind ? &value : nullptr;
  };
  const std::size_t dot = option.key.find('.');
  ConfigNode* section = below(root, option.key.substr(0, dot), ConfigNode::Kind::map);
  ConfigNode* list =
      section == nullptr ? nullptr : below(*section, option.key.substr(dot + 1), ConfigNode::Kind::sequence);
  if (list == nullptr) return;
  ConfigNode item;
  item.kind = ConfigNode::Kind::scalar;
  item.scalar = option.value;
  item.mark = mark;
  list->items.push_back(std::move(item));
}

ConfigNode merged_tree(const ConfigSource& source, std::vector<Diagnostic>& problems) {
  ConfigNode root;
  root.kind = ConfigNode::Kind::map;
  if (source.file) root = FileChain(problems).load(source.file->string(), nullptr);
  Overrides overrides(problems);
  for (std::size_t i = 0; i < source.set.size(); ++i) overrides.set(source.set[i], static_cast<int>(i) + 1);
  for (const auto& option : source.options)
    if (!option.adds) overrides.option(option);
  merge_config(root, overrides.take(), problems);
  for (const auto& option : source.options)
    if (option.adds) add_to_list(root, option);
  ConfigNode sections;
  sections.kind = ConfigNode::Kind::map;
  sections.members = source.sections;
  merge_config(root, std::move(sections), problems);
  return root;
}

}  // namespace dismantle
