#include "config/binder.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config_limits.h"
#include "config/list_items.h"

namespace dismantle {
namespace {

/// The declaration of `key`; nullptr when there is none.
const ParamSpec* spec_of(const std::vector<ParamSpec>& specs, const std::string& key) {
  const auto it = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == key; });
  return it == specs.end() ? nullptr : &*it;
}

/// An empty map at `mark`.
ConfigNode nothing_said(const ConfigMark& mark) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::map;
  node.mark = mark;
  return node;
}

struct Deeper {
  explicit Deeper(unsigned& count) : depth(++count) {}
  ~Deeper() { --depth; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;
  unsigned& depth;
};

}  // namespace

TypeSource types_of(const Registry& registry) {
  return {[&registry](PluginKind kind, const std::string& id) { return registry.lookup(kind, id); },
          [&registry](PluginKind kind, const std::string& id) { return registry.why_missing(kind, id); }};
}

std::string source_text(const RegisteredType& type) {
  return fmt::format("{} {}, {}", type.type.id, type.file->version, type.file->path.filename().string());
}

std::string key_of(const std::string& section, const ParamSpec& spec) {
  return fmt::format("{}.{}{}", section, spec.advanced ? "advanced." : "", spec.name);
}

std::string default_origin(const RegisteredType& type) {
  return type.preset_of.empty() ? "default" : "preset " + type.type.id;
}

/// The value of a parameter that the map does not set; nullptr when there is none.
const ParamValue* Binder::value_below(const Part& part, const ParamSpec& spec) {
  if (part.below != nullptr)
    if (const auto it = part.below->find(spec.name); it != part.below->end()) return &it->second;
  return spec.required ? nullptr : &spec.fallback;
}

ParamSet Binder::section(const std::vector<ParamSpec>& specs, const ConfigNode* node, const SectionContext& context,
                         const std::string& origin) {
  std::vector<Part> parts{{&specs, nullptr, origin}};
  bind_parts(parts, node, context);
  return std::move(parts.front().values);
}

std::optional<PluginChoice> Binder::choice(PluginKind kind, const std::vector<ParamSpec>& options,
                                           const ConfigNode& node, const std::string& name, const PluginChoice* below,
                                           const std::string& origin) {
  const auto fail = [&](const ConfigMark& mark, const std::string& what) {
    problems_.push_back(mark.error(what));
    return std::nullopt;
  };
  const Deeper deeper(depth_);
  if (depth_ > kConfigLimits.plugins)
    return fail(node.mark, fmt::format("{}: plugins hold each other more than {} deep", name, kConfigLimits.plugins));
  const ConfigMember* type = node.is_map() ? node.find("type") : nullptr;
  const ConfigNode* id = type != nullptr ? &type->value : node.is_scalar() ? &node : nullptr;
  if (!node.is_map() && !node.is_scalar())
    return fail(node.mark, fmt::format("{} must be a {}, as '{{type: ID, ...}}', got {}", name, to_string(kind),
                                       node.kind_name()));
  if (id == nullptr && below == nullptr)
    return fail(node.mark, fmt::format("{} has no 'type': it must be the id of a {}", name, to_string(kind)));
  if (id != nullptr && (!id->is_scalar() || id->scalar.empty()))
    return fail(id->mark,
                fmt::format("{}.type must be the id of a {}, got {}", name, to_string(kind), id->kind_name()));
  PluginChoice out;
  out.type = id != nullptr ? id->scalar : below->type;
  const RegisteredType* found = types_.lookup(kind, out.type);
  if (found == nullptr) return fail((id != nullptr ? *id : node).mark, types_.why_missing(kind, out.type));
  if (below != nullptr && below->type != out.type) below = nullptr;  // another type: its values do not apply
  for (const ParamSpec& option : options)
    if (spec_of(found->type.params, option.name) != nullptr)
      return fail(node.mark, fmt::format("{}: '{}' has a parameter '{}', which here is read by what holds it, so that "
                                         "it cannot stand here",
                                         name, out.type, option.name));
  std::vector<Part> parts{
      {&options, below != nullptr ? &below->options : nullptr, below != nullptr ? origin : "default"},
      {&found->type.params, below != nullptr ? &below->parameters : nullptr,
       below != nullptr ? origin : default_origin(*found)}};
  bind_parts(parts, node.is_map() ? &node : nullptr, {name, out.type, source_text(*found)});
  out.options = std::move(parts[0].values);
  out.parameters = std::move(parts[1].values);
  origins_[name + ".type"] = id != nullptr ? id->mark.text() : origin;
  return out;
}

void Binder::bind_parts(std::vector<Part>& parts, const ConfigNode* node, const SectionContext& context) {
  Keys keys{context, {}, {}};
  for (const Part& part : parts)
    for (const auto& spec : *part.specs) (spec.advanced ? keys.advanced : keys.declared).push_back(spec.name);
  if (!keys.advanced.empty()) keys.declared.emplace_back("advanced");
  if (node != nullptr && !node->is_map())
    problems_.push_back(
        node->mark.error(fmt::format("{} must be a map of keys, not {}", context.name, node->kind_name())));
  if (node != nullptr && node->is_map()) {
    for (const auto& member : node->members) {
      if (member.key == "type" && !context.type.empty()) continue;
      if (member.key == "advanced" && !keys.advanced.empty())
        bind_advanced(parts, member, keys);
      else
        bind_key(parts, member, false, keys);
    }
  }
  if (!keys.displaced.empty()) {
    std::string right;
    for (const ConfigMember* member : keys.displaced)
      right += fmt::format("{}{}.advanced.{}", right.empty() ? "" : ", ", context.name, member->key);
    warnings_.push_back(keys.displaced.front()->key_mark.warning(
        fmt::format("advanced parameters are keys of the map 'advanced': write {}", right)));
  }
  for (Part& part : parts) {
    for (const auto& spec : *part.specs) {
      if (part.values.contains(spec.name)) continue;
      const ParamValue* fallback = value_below(part, spec);
      if (fallback != nullptr) {
        const ConfigNode untouched = nothing_said(node != nullptr ? node->mark : ConfigMark{});
        part.values.emplace(spec.name, defaulted(spec, *fallback, untouched, key_of(context.name, spec), part.origin));
      } else if (std::find(keys.failed.begin(), keys.failed.end(), spec.name) == keys.failed.end()) {
        const std::string text =
            fmt::format("{} ({}) needs the key '{}', which has no default", context.name, context.type, spec.name);
        problems_.push_back(node != nullptr ? node->mark.error(text) : Diagnostic{"", 0, 0, text});
      }
    }
  }
}

void Binder::bind_advanced(std::vector<Part>& parts, const ConfigMember& member, Keys& keys) {
  if (!member.value.is_map())
    problems_.push_back(member.value.mark.error(
        fmt::format("{}.advanced must be a map of keys, not {}", keys.context.name, member.value.kind_name())));
  for (const auto& inner : member.value.members) bind_key(parts, inner, true, keys);
}

void Binder::bind_key(std::vector<Part>& parts, const ConfigMember& member, bool in_advanced, Keys& keys) {
  const SectionContext& context = keys.context;
  const auto fail = [&](const std::string& what) { problems_.push_back(member.key_mark.error(what)); };
  const auto home =
      std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return spec_of(*p.specs, member.key) != nullptr; });
  if (home == parts.end()) {
    if (in_advanced)
      return fail(unknown_key_message(member.key, {context.name + ".advanced", context.type, context.source},
                                      keys.advanced, homes_));
    return fail(unknown_key_message(member.key, context, keys.declared, homes_, keys.advanced));
  }
  const ParamSpec& spec = *spec_of(*home->specs, member.key);
  if (in_advanced && !spec.advanced)
    fail(fmt::format("'{}' is not an advanced parameter: write {}", member.key, key_of(context.name, spec)));
  if (home->values.contains(member.key))
    return fail(fmt::format("{} is set twice, inside the map 'advanced' and outside", key_of(context.name, spec)));
  if (spec.advanced && !in_advanced) keys.displaced.push_back(&member);
  if (auto bound = value(spec, member.value, context, value_below(*home, spec), home->origin))
    home->values.emplace(member.key, std::move(*bound));
  else
    keys.failed.push_back(member.key);
}

/// A value that no layer sets. Default plugins may lack parameters; these are filled in here.
ParamValue Binder::defaulted(const ParamSpec& spec, const ParamValue& value, const ConfigNode& untouched,
                             const std::string& name, const std::string& origin) {
  if (const auto* one = std::get_if<PluginChoice>(&value))
    return choice(spec.plugin_kind, {}, untouched, name, one, origin).value_or(*one);
  if (const auto* many = std::get_if<std::vector<PluginChoice>>(&value)) {
    std::vector<PluginChoice> all = *many;
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k] = choice(spec.plugin_kind, spec.options, untouched, fmt::format("{}.{}", name, k), &(*many)[k], origin)
                   .value_or(all[k]);
    return all;
  }
  origins_[name] = origin;
  return value;
}

std::optional<ParamValue> Binder::value(const ParamSpec& spec, const ConfigNode& node, const SectionContext& context,
                                        const ParamValue* below, const std::string& origin) {
  const std::string name = key_of(context.name, spec);
  if (spec.type == ParamType::plugin) {
    const auto* under = below != nullptr ? std::get_if<PluginChoice>(below) : nullptr;
    auto bound = choice(spec.plugin_kind, {}, node, name, under, origin);
    return bound ? std::optional<ParamValue>(std::move(*bound)) : std::nullopt;
  }
  if (spec.type == ParamType::plugins) return list(spec, node, name, below, origin);
  auto bound = bind_value(spec, node, context, problems_);
  if (bound) origins_[name] = node.mark.text();
  return bound;
}

std::optional<ParamValue> Binder::list(const ParamSpec& spec, const ConfigNode* node, const std::string& name) {
  if (node != nullptr) return list(spec, *node, name, &spec.fallback, "default");
  return defaulted(spec, spec.fallback, nothing_said({}), name, "default");
}

std::optional<ParamValue> Binder::list(const ParamSpec& spec, const ConfigNode& node, const std::string& name,
                                       const ParamValue* below, const std::string& origin) {
  const auto* under = below != nullptr ? std::get_if<std::vector<PluginChoice>>(below) : nullptr;
  std::vector<PluginChoice> out;
  bool good = true;
  const auto item_name = [&](std::size_t k) { return fmt::format("{}.{}", name, k); };
  if (node.kind == ConfigNode::Kind::sequence) {
    for (std::size_t k = 0; k < node.items.size(); ++k) {
      auto bound = choice(spec.plugin_kind, spec.options, node.items[k], item_name(k), nullptr, origin);
      good = good && bound.has_value();
      if (bound) out.push_back(std::move(*bound));
    }
    if (node.items.empty() && !spec.may_be_empty) {
      problems_.push_back(node.mark.error(fmt::format("{} has to name a {}", name, to_string(spec.plugin_kind))));
      return std::nullopt;
    }
  } else if (node.is_map() && under != nullptr) {
    std::vector<std::string> types;
    out = std::get<std::vector<PluginChoice>>(defaulted(spec, *below, nothing_said(node.mark), name, origin));
    for (const PluginChoice& item : out) types.push_back(item.type);
    for (const auto& member : node.members) {
      const auto index = item_index(member.key, types);
      if (!index) {
        problems_.push_back(member.key_mark.error(no_item_message(name, member.key, types)));
        good = false;
        continue;
      }
      const PluginChoice before = out[*index];
      auto bound = choice(spec.plugin_kind, spec.options, member.value, item_name(*index), &before, origin);
      good = good && bound.has_value();
      if (bound) out[*index] = std::move(*bound);
    }
  } else {
    problems_.push_back(node.mark.error(
        fmt::format("{} must be a list of {}s, got {}", name, to_string(spec.plugin_kind), node.kind_name())));
    return std::nullopt;
  }
  return good ? std::optional<ParamValue>(std::move(out)) : std::nullopt;
}

}  // namespace dismantle
