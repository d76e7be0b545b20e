// The section `immobility:`: which provers run, in which order, and when.
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"

namespace dismantle {

ParamSpec provers_parameter(const Registry& registry) {
  const char* const built_in[] = {"overlap_lock", "enclosed_ball",       "ring",        "spool", "hook",
                                  "disc",         "configuration_cells", "interlock_lp"};
  ParamSpec spec;
  spec.name = "provers";
  spec.type = ParamType::plugins;
  spec.plugin_kind = PluginKind::immobility_prover;
  spec.may_be_empty = true;
  spec.doc = "Immobility provers, in the order in which they are asked; [] = none.";
  std::vector<PluginChoice> fallback;
  for (const char* id : built_in)
    if (registry.lookup(PluginKind::immobility_prover, id) != nullptr) fallback.push_back({id, {}, {}});
  spec.fallback = std::move(fallback);
  return spec;
}

std::vector<ParamSpec> immobility_parameters(const Registry& registry) {
  std::vector<ParamSpec> all = {provers_parameter(registry)};
  const std::vector<ParamSpec> when = Schema<ProofOptions>().specs();
  all.insert(all.end(), when.begin(), when.end());
  return all;
}

}  // namespace dismantle
