/// Binds sections whose parameters may be plugins with parameters of their own, to any depth.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/host/config_bind.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// Looks up plugin types while choices are bound.
struct TypeSource {
  std::function<const RegisteredType*(PluginKind, const std::string&)> lookup;  ///< nullptr: no such type
  std::function<std::string(PluginKind, const std::string&)> why_missing;
};
/// Looks up the types of `registry`, which must outlive the result.
TypeSource types_of(const Registry& registry);

/// "bfs 0.1.0, libbfs.so", for messages.
std::string source_text(const RegisteredType& type);
/// "path_planner.motion"; an advanced parameter is a key of the map `advanced`: "path_planner.advanced.thinning".
std::string key_of(const std::string& section, const ParamSpec& spec);
/// The origin to state for a value that no layer sets: "default" or "preset guided".
std::string default_origin(const RegisteredType& type);

class Binder {
 public:
  /// All arguments must outlive this.
  Binder(const TypeSource& types, const KeyHomes& homes, std::map<std::string, std::string>& origins,
         std::vector<Diagnostic>& problems, std::vector<std::string>& warnings)
      : types_(types), homes_(homes), origins_(origins), problems_(problems), warnings_(warnings) {}

  /// The values of a section (`node` may be nullptr: all defaults), complete unless there were problems. `origin`:
  /// origin to state for default values.
  ParamSet section(const std::vector<ParamSpec>& specs, const ConfigNode* node, const SectionContext& context,
                   const std::string& origin = "default");

  /// Binds a plugin choice, `{type: ID, ...}` or `ID`. `name`: its key, "path_planner.of.1". `below`: the choice whose
  /// values are used unless the type changes; may be nullptr. On an error: nothing, and a diagnostic.
  std::optional<PluginChoice> choice(PluginKind kind, const std::vector<ParamSpec>& options, const ConfigNode& node,
                                     const std::string& name, const PluginChoice* below, const std::string& origin);

  /// Binds a list of plugins that is no key of a section (`node` may be nullptr: the default). On an error: nothing,
  /// and a diagnostic.
  std::optional<ParamValue> list(const ParamSpec& spec, const ConfigNode* node, const std::string& name);

 private:
  /// One of several parameter sets whose values are in the same map.
  struct Part {
    const std::vector<ParamSpec>* specs;
    const ParamSet* below;  ///< nullptr: the declared defaults
    std::string origin;     ///< of the values in `below`, or of the defaults
    ParamSet values{};
  };

  /// A map of keys as it is read, and what was found in it.
  struct Keys {
    const SectionContext& context;
    std::vector<std::string> declared, advanced;   ///< names of the parameters
    std::vector<const ConfigMember*> displaced{};  ///< advanced parameters outside the map `advanced`
    std::vector<std::string> failed{};
  };

  void bind_parts(std::vector<Part>& parts, const ConfigNode* node, const SectionContext& context);
  /// Binds one key of the section, or of its map `advanced`.
  void bind_key(std::vector<Part>& parts, const ConfigMember& member, bool in_advanced, Keys& keys);
  void bind_advanced(std::vector<Part>& parts, const ConfigMember& member, Keys& keys);
  static const ParamValue* value_below(const Part& part, const ParamSpec& spec);
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
  std::vector<std::string>& warnings_;
  unsigned depth_ = 0;
};

}  // namespace dismantle
