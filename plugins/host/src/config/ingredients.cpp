#include "dismantle/host/ingredients.h"

namespace dismantle {

Ingredients ingredients_of(const RunConfig& config, const Registry& registry) {
  Ingredients out;
  out.simulator = registry.create<Simulator>(config.simulator.type, config.simulator.params);
  out.path_planner = [&registry, choice = config.path_planner] {
    return registry.create<PathPlanner>(choice.type, choice.params);
  };
  out.sequence_planner = registry.create<SequencePlanner>(config.sequence_planner.type, config.sequence_planner.params);
  out.path_planner_id = config.path_planner.type;
  if (config.layout.enabled) {
    out.transfer_planner = [&registry, choice = config.transfer_planner] {
      return registry.create<TransferPlanner>(choice.type, choice.params);
    };
    out.transfer_planner_id = config.transfer_planner.type;
  }
  return out;
}

RunOptions run_options_of(const RunConfig& config, const std::string& part) {
  RunOptions out;
  out.path_timeout = config.run.path_timeout;
  out.path_steps = static_cast<std::uint64_t>(config.run.path_steps);
  out.only_part = part;
  out.verify = config.verify;
  out.layout = config.layout;
  out.seed = static_cast<std::uint64_t>(config.run.seed);
  return out;
}

std::vector<std::shared_ptr<Importer>> importers_of(const Registry& registry) {
  std::vector<std::shared_ptr<Importer>> out;
  for (const RegisteredType* type : registry.types(PluginKind::importer))
    out.push_back(registry.create<Importer>(type->type.id));
  return out;
}

}  // namespace dismantle
