#include "config/immobility.h"

#include <fmt/format.h>

#include <algorithm>

namespace dismantle {
namespace {

class Reader {
 public:
  Reader(const Registry& registry, const KeyHomes& homes, std::map<std::string, std::string>& origins,
         std::vector<Diagnostic>& problems)
      : registry_(registry), homes_(homes), origins_(origins), problems_(problems) {}

  /// The built-in provers that are there, with default parameters.
  std::vector<PluginChoice> defaults() {
    origins_["immobility.provers"] = "default";
    for (const char* id : default_provers())
      if (const auto* type = registry_.lookup(PluginKind::immobility_prover, id); type != nullptr) {
        std::map<std::string, std::string> unnamed;
        choices_.push_back(
            {id, bind_section(type->type.params, nullptr, {"immobility", id, ""}, homes_, unnamed, problems_)});
      }
    return std::move(choices_);
  }

  std::vector<PluginChoice> read(const ConfigNode& section) {
    if (!section.is_map()) {
      problems_.push_back(
          section.mark.error(fmt::format("immobility must be a map of keys, not {}", section.kind_name())));
      return {};
    }
    const ConfigMember* list = nullptr;
    for (const auto& member : section.members) {
      if (member.key == "provers")
        list = &member;
      else
        problems_.push_back(
            member.key_mark.error(unknown_key_message(member.key, {"immobility", "", ""}, {"provers"}, homes_)));
    }
    if (list == nullptr) return defaults();
    origins_["immobility.provers"] = list->value.mark.text();
    if (list->value.kind != ConfigNode::Kind::sequence) {
      problems_.push_back(list->value.mark.error(
          fmt::format("immobility.provers must be a list of immobility provers, not {}", list->value.kind_name())));
      return {};
    }
    for (const ConfigNode& item : list->value.items) add(item);
    return std::move(choices_);
  }

 private:
  /// `id`, or `{type: id, parameter: value, ...}`.
  void add(const ConfigNode& item) {
    const ConfigMember* type = item.is_map() ? item.find("type") : nullptr;
    const ConfigNode& id = type != nullptr ? type->value : item;
    if (!id.is_scalar() || id.scalar.empty()) {
      problems_.push_back(
          item.mark.error("an entry of immobility.provers must be the id of an immobility prover, or a "
                          "map with its type and parameters"));
      return;
    }
    const auto* found = registry_.lookup(PluginKind::immobility_prover, id.scalar);
    if (found == nullptr) {
      problems_.push_back(id.mark.error(registry_.why_missing(PluginKind::immobility_prover, id.scalar)));
      return;
    }
    if (std::any_of(choices_.begin(), choices_.end(), [&](const PluginChoice& c) { return c.type == id.scalar; })) {
      problems_.push_back(id.mark.error(fmt::format("immobility.provers lists '{}' twice", id.scalar)));
      return;
    }
    const std::string source =
        fmt::format("{} {}, {}", found->type.id, found->file->version, found->file->path.filename().string());
    choices_.push_back(
        {id.scalar, bind_section(found->type.params, item.is_map() ? &item : nullptr,
                                 {"immobility.provers." + id.scalar, id.scalar, source}, homes_, origins_, problems_)});
  }

  const Registry& registry_;
  const KeyHomes& homes_;
  std::map<std::string, std::string>& origins_;
  std::vector<Diagnostic>& problems_;
  std::vector<PluginChoice> choices_;
};

}  // namespace

const std::vector<const char*>& default_provers() {
  static const std::vector<const char*> ids = {"overlap_lock", "enclosed_ball",       "ring",        "spool", "hook",
                                               "disc",         "configuration_cells", "interlock_lp"};
  return ids;
}

std::vector<PluginChoice> read_immobility(const ConfigNode* section, const Registry& registry, const KeyHomes& homes,
                                          std::map<std::string, std::string>& origins,
                                          std::vector<Diagnostic>& problems) {
  Reader reader(registry, homes, origins, problems);
  return section == nullptr ? reader.defaults() : reader.read(*section);
}

}  // namespace dismantle
