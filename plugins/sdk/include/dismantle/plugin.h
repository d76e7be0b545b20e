/// What a plugin includes: registration macro and registrar. See docs/write-a-planner.md.
///
///   DISMANTLE_PLUGIN("acme.planners", "1.2.0", "BSD-3-Clause", "https://example.org") {
///     r.add<dismantle::PathPlanner, AcmeRrt, AcmeRrtParameters>("acme.rrt", "Single-tree RRT in SE(3).", {.source =
///     "LaValle 1998"});
///   }
///
/// Impl is constructible from `const Parameters&`. Parameters declares itself (dismantle/parameters.h).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/immobility_prover.h"
#include "dismantle/importer.h"
#include "dismantle/parameters.h"
#include "dismantle/path_planner.h"
#include "dismantle/plugin/abi.h"
#include "dismantle/plugin_kind.h"
#include "dismantle/plugin_ref.h"
#include "dismantle/sequence_planner.h"
#include "dismantle/simulator.h"
#include "dismantle/step_check.h"
#include "dismantle/transfer_planner.h"

namespace dismantle {

/// For plugin types without parameters.
struct NoParameters {
  static void describe(Schema<NoParameters>&) {}
};

/// Facts about a type that can be read without creating an object.
struct TypeTraits {
  std::string source{};        ///< paper section or reference
  Capabilities needs = {};     ///< path and transfer planners: required of the simulator
  Capabilities provides = {};  ///< simulators
};

/// One registered type. `create` takes a complete ParamSet and returns a pointer to the interface of `kind`. The
/// PluginMaker creates the plugins that the parameters name and stays callable as long as the object lives.
struct PluginType {
  PluginKind kind = PluginKind::simulator;
  std::string id;
  std::string summary;
  TypeTraits traits;
  std::vector<ParamSpec> params;
  std::function<std::shared_ptr<void>(const ParamSet&, const PluginMaker&)> create;
};

/// Collects the types of a plugin. The host creates it; the plugin only fills it.
class Registrar {
 public:
  template <class Interface, class Impl, class Parameters = NoParameters>
  void add(std::string id, std::string summary, TypeTraits traits = {}) {
    auto schema = std::make_shared<Schema<Parameters>>();
    PluginType type;
    type.kind = PluginKindOf<Interface>::value;
    type.id = std::move(id);
    type.summary = std::move(summary);
    type.traits = std::move(traits);
    type.params = schema->specs();
    type.create = [schema](const ParamSet& values, const PluginMaker& make) -> std::shared_ptr<void> {
      const Parameters params = schema->bind(values, make);
      std::shared_ptr<Interface> object;
      if constexpr (std::is_constructible_v<Impl, const Parameters&>)
        object = std::make_shared<Impl>(params);
      else
        object = std::make_shared<Impl>();
      return object;
    };
    types_.push_back(std::move(type));
  }
  const std::vector<PluginType>& types() const { return types_; }

 private:
  std::vector<PluginType> types_;
};

}  // namespace dismantle

#include "dismantle/plugin/register.h"  // needs everything above
