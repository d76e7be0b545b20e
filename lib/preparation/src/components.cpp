#include "dismantle/preparation/components.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "dismantle/preparation/name_pattern.h"

namespace dismantle {
namespace {

/// One use of a product.
struct Use {
  std::string instance;  ///< name of the use; that of the product if it has none
  std::string product;   ///< of a leaf; empty: not known
  std::size_t depth = 0;
  std::string above;             ///< id
  std::vector<PartId> parts;     ///< all below it
  std::vector<PartId> own;       ///< its own bodies
  bool has_uses = false;         ///< other products are used in it
};

/// The name of the `i`-th use that contains a part. The outermost one may be the file, which has no name.
std::string name_of(const Part& part, std::size_t i) {
  if (i + 1 == part.instances.size()) return part.product;
  const std::size_t unnamed = part.instances.size() - 1 - std::min(part.instances.size() - 1, part.parents.size());
  return i < unnamed ? "" : part.parents.at(i - unnamed);
}

std::map<std::string, Use> uses_of(const Assembly& assembly) {
  std::map<std::string, Use> uses;
  for (const Part& part : assembly.parts)
    for (std::size_t i = 0; i < part.instances.size(); ++i) {
      Use& use = uses[part.instances[i]];
      use.instance = name_of(part, i);
      use.depth = i;
      if (i > 0) use.above = part.instances[i - 1];
      use.parts.push_back(part.id);
      if (i + 1 == part.instances.size()) {
        use.own.push_back(part.id);
        use.product = part.product;
      } else {
        use.has_uses = true;
      }
    }
  return uses;
}

class Reading {
 public:
  Reading(const Assembly& assembly, const ComponentChoice& choice)
      : assembly_(assembly), choice_(choice), uses_(uses_of(assembly)) {}

  std::vector<Component> components() {
    std::vector<const Use*> outer_first;
    for (const auto& [id, use] : uses_)
      if (use.parts.size() > 1) outer_first.push_back(&use);
    std::ranges::stable_sort(outer_first, {}, [](const Use* u) { return std::pair(u->depth, u->parts.front()); });
    std::vector<Component> out;
    std::set<PartId> kept;
    for (const Use* use : outer_first) {
      if (kept.contains(use->parts.front())) continue;  // within a unit
      std::optional<Component> component = read(*use);
      if (!component) continue;
      if (component->kept) kept.insert(use->parts.begin(), use->parts.end());
      out.push_back(std::move(*component));
    }
    std::ranges::stable_sort(out, {}, [](const Component& c) { return c.parts.front(); });
    give_names(out);
    return out;
  }

 private:
  /// None: nothing is to be said about it.
  std::optional<Component> read(const Use& use) const {
    const std::string& product = use.product.empty() ? use.instance : use.product;
    const auto reads = [&](bool kept, std::string reason) {
      return Component{use.instance, product, use.parts, kept, std::move(reason)};
    };
    const auto asked = [&](const std::vector<std::string>& patterns) -> const std::string* {
      const auto found = std::ranges::find_if(
          patterns, [&](const auto& p) { return name_matches(use.instance, p) || name_matches(product, p); });
      return found == patterns.end() ? nullptr : &*found;
    };
    if (const std::string* pattern = asked(choice_.apart))
      return reads(false, fmt::format("components.apart names it ('{}')", *pattern));
    if (const std::string* pattern = asked(choice_.together))
      return reads(true, fmt::format("components.together names it ('{}')", *pattern));
    const auto level = choice_.level.value_or(ComponentChoice::Level::component);
    const bool leaf = !use.has_uses;
    if (level == ComponentChoice::Level::solid)
      return leaf ? std::optional(reads(false, "components.level is solid")) : std::nullopt;
    if (level == ComponentChoice::Level::depth && use.depth > 0 && use.depth == choice_.depth)
      return reads(true, fmt::format("components.level is {}", choice_.depth));
    if (!leaf) return std::nullopt;
    if (use.depth == 0) return reads(false, "its bodies belong to the root of the file");
    if (use.parts.size() == assembly_.parts.size()) return reads(false, "the file has no other product");
    return reads(true, reason_of_leaf(use));
  }

  /// A printed part of several bodies looks like a purchased one: the file does not tell them apart.
  std::string reason_of_leaf(const Use& use) const {
    std::string out = fmt::format("one product of {} bodies, in which no other product is used", use.own.size());
    if (mostly_several()) out += "; doubtful: most products of the file have several bodies";
    return out;
  }

  /// Do most products of the file have several bodies?
  bool mostly_several() const {
    std::set<std::string> single, several;
    for (const auto& [id, use] : uses_)
      if (!use.own.empty()) (use.own.size() > 1 ? several : single).insert(use.product);
    return several.size() > single.size();
  }

  void give_names(std::vector<Component>& components) const {
    std::set<std::string> taken;
    for (const Part& part : assembly_.parts) taken.insert(part.name);
    for (Component& c : components) {
      const std::string name = c.name.empty() ? "component" : c.name;
      c.name = name;
      for (int k = 2; !taken.insert(c.name).second; ++k) c.name = fmt::format("{}#{}", name, k);
    }
  }

  const Assembly& assembly_;
  const ComponentChoice& choice_;
  std::map<std::string, Use> uses_;
};

}  // namespace

std::vector<std::string> product_names(const Assembly& assembly) {
  std::set<std::string> names;
  for (const auto& [id, use] : uses_of(assembly))
    for (const std::string& name : {use.instance, use.product})
      if (!name.empty()) names.insert(name);
  return {names.begin(), names.end()};
}

std::vector<Component> components_of(const Assembly& assembly, const ComponentChoice& choice) {
  return Reading(assembly, choice).components();
}

}  // namespace dismantle
