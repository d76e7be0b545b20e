/// The provers of the default configuration, for tests that link dismantle_plugins.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::fake {

/// The registry with the built-in plugins of the build, scanned once.
inline const Registry& plugin_registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

/// The built provers with default parameters, in their default order.
inline const std::vector<NamedProver>& built_in_provers() {
  static const std::vector<NamedProver> all = [] {
    std::vector<NamedProver> provers;
    for (const PluginChoice& choice : default_list(&RunConfig::provers, plugin_registry()))
      provers.push_back({choice.type, plugin_registry().create<ImmobilityProver>(choice.type)});
    return provers;
  }();
  return all;
}

/// The built-in prover of that id, with its defaults.
inline std::shared_ptr<const ImmobilityProver> prover_of_kind(const std::string& kind) {
  for (const NamedProver& p : built_in_provers())
    if (p.id == kind) return p.prover;
  return nullptr;
}

}  // namespace dismantle::fake
