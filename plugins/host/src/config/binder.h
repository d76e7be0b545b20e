/// Binds sections whose parameters may hold plugins, which have parameters of their own, and so on.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/host/config_bind.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// Where plugin types are looked up while choices are bound.
struct TypeSource {
  std::function<const RegisteredType*(PluginKind, const std::string&)> lookup;  ///< nullptr: there is none
  std::function<std::string(PluginKind, const std::string&)> why_missing;
};
/// What a registry holds. `registry` outlives it.
TypeSource types_of(const Registry& registry);

/// "bfs 0.1.0, libbfs.so", for messages.
std::string source_text(const RegisteredType& type);
/// The stated origin of a value that no layer sets: "default", or "preset guided".
std::string default_origin(const RegisteredType& type);

class Binder {
 public:
  /// All outlive this.
  Binder(const TypeSource& types, const KeyHomes& homes, std::map<std::string, std::string>& origins,
         std::vector<Diagnostic>& problems)
      : types_(types), homes_(homes), origins_(origins), problems_(problems) {}

  /// The values of a section (`node` may be nullptr: all defaults), complete unless there were problems. `origin`: of
  /// the values that are defaults.
  ParamSet section(const std::vector<ParamSpec>& specs, const ConfigNode* node, const SectionContext& context,
                   const std::string& origin = "default");

  /// A choice of a plugin, `{type: ID, ...}` or just `ID`. `name`: its place, "path_planner.of.1". `below`: what is
  /// laid under it as long as the type stays; may be nullptr. Nothing, and a diagnostic, where no such type can be had.
  std::optional<PluginChoice> choice(PluginKind kind, const std::vector<ParamSpec>& options, const ConfigNode& node,
                                     const std::string& name, const PluginChoice* below, const std::string& origin);

 private:
  /// One of the sets of values that a map holds side by side.
  struct Part {
    const std::vector<ParamSpec>* specs;
    const ParamSet* below;  ///< nullptr: the declared defaults
    std::string origin;     ///< of these
    ParamSet values{};
  };

  void bind_parts(std::vector<Part>& parts, const ConfigNode* node, const SectionContext& context);
  std::optional<ParamValue> value(const ParamSpec& spec, const ConfigNode& node, const SectionContext& context,
                                  const ParamValue* below, const std::string& origin);
  std::optional<ParamValue> list(const ParamSpec& spec, const ConfigNode& node, const std::string& name,
                                 const ParamValue* below, const std::string& origin);
  ParamValue defaulted(const ParamSpec& spec, const ParamValue& value, const ConfigNode& untouched,
                       const std::string& name, const std::string& origin);

  const TypeSource& types_;
  const KeyHomes& homes_;
  std::map<std::string, std::string>& origins_;
  std::vector<Diagnostic>& problems_;
  unsigned depth_ = 0;
};

}  // namespace dismantle
