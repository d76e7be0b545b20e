/// Reference to a plugin that another plugin's parameter names. The host binds it; its holder creates objects.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "dismantle/param_value.h"
#include "dismantle/plugin_kind.h"

namespace dismantle {

/// Creates an object of the chosen type and returns a pointer to the interface of that kind. Provided by the host.
/// Throws PluginError on failure. May be called from any thread.
using PluginMaker = std::function<std::shared_ptr<void>(PluginKind, const PluginChoice&)>;

/// Member of a parameter struct: `PluginRef<PathPlanner> inner{"bfs"};`. Lists: ParamTraits and Schema::add.
template <class Interface>
class PluginRef {
 public:
  /// What the plugin is used as.
  using interface_type = Interface;
  static constexpr PluginKind kind = PluginKindOf<Interface>::value;

  /// No default: the configuration has to name a plugin.
  PluginRef() = default;
  /// The default of a parameter: that type with its default parameters.
  explicit PluginRef(std::string type) : choice_{std::move(type), {}, {}} {}
  /// Bound.
  PluginRef(PluginChoice choice, PluginMaker make) : choice_(std::move(choice)), make_(std::move(make)) {}

  const std::string& type() const { return choice_.type; }
  const PluginChoice& choice() const { return choice_; }

  /// Creates a new object. @throws PluginError from the host; std::logic_error when no host has bound this.
  std::shared_ptr<Interface> create() const {
    if (!make_) throw std::logic_error("plugin '" + choice_.type + "' was named, but not bound by a host");
    return std::static_pointer_cast<Interface>(make_(kind, choice_));
  }

 private:
  PluginChoice choice_;
  PluginMaker make_;
};

/// True for PluginRef types.
template <class T>
inline constexpr bool is_plugin_ref = false;
/// True for PluginRef types.
template <class Interface>
inline constexpr bool is_plugin_ref<PluginRef<Interface>> = true;

}  // namespace dismantle
