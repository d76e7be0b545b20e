#include "planning_setup.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "dismantle/engine/judgement.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/session/objective.h"

namespace dismantle {

namespace {

/// Is this plugin chosen, or one of those that it is composed of?
bool names(const PluginChoice& choice, const std::string& type) {
  if (choice.type == type) return true;
  return std::any_of(choice.parameters.begin(), choice.parameters.end(), [&](const auto& parameter) {
    const auto is_named = [&](const PluginChoice& inner) { return names(inner, type); };
    if (const auto* one = std::get_if<PluginChoice>(&parameter.second)) return is_named(*one);
    const auto* many = std::get_if<std::vector<PluginChoice>>(&parameter.second);
    return many != nullptr && std::any_of(many->begin(), many->end(), is_named);
  });
}

/// The chosen sequence planner; with run.force: last_resort followed by `least_cut`.
PluginChoice with_last_resort(const RunConfig& config, const Registry& registry) {
  if (config.run.force == ForceWhen::off || names(config.sequence_planner, "least_cut")) return config.sequence_planner;
  for (const char* needed : {"chain", "least_cut"})
    if (registry.lookup(PluginKind::sequence_planner, needed) == nullptr)
      throw Error(std::string("run.force: last_resort needs the sequence planner '") + needed +
                  "', which is not there; set run.force: off");
  return {"chain", {{"of", std::vector<PluginChoice>{config.sequence_planner, {"least_cut", {}, {}}}}}, {}};
}

/// With a target, steps are counted: one more costs more than other checks usually say of a step.
std::vector<PluginChoice> checks_of(const RunConfig& config, const Registry& registry) {
  std::vector<PluginChoice> objective = config.objective;
  const auto counts = [](const PluginChoice& choice) { return choice.type == "steps"; };
  constexpr double kWeight = 1000;
  if (!config.constraints.target.empty() && registry.lookup(PluginKind::step_check, "steps") != nullptr &&
      std::none_of(objective.begin(), objective.end(), counts))
    objective.push_back({"steps", {}, {{"weight", kWeight}, {"require", false}}});
  return objective;
}

/// `blocking` finds the first plan of a `best_order` upwards, unless stated otherwise: with the base at the end, that
/// is close to what objectives like.
void look_upwards(PluginChoice& choice) {
  if (choice.type == "blocking") {
    ParamValue& upwards = choice.parameters.try_emplace("upwards", "auto").first->second;
    if (upwards == ParamValue("auto")) upwards = "on";
  }
  for (auto& [name, value] : choice.parameters) {
    if (auto* one = std::get_if<PluginChoice>(&value)) look_upwards(*one);
    if (auto* many = std::get_if<std::vector<PluginChoice>>(&value))
      for (PluginChoice& inner : *many) look_upwards(inner);
  }
}

/// The same in a `best_order`, if some orders are better than others.
PluginChoice with_best_order(const RunConfig& config, const Registry& registry, const Objective& objective,
                             PluginChoice sequence) {
  if (!prefers_orders(objective)) return sequence;
  const bool wrapped = names(sequence, "best_order");
  if (!wrapped && (!config.run.best_order || registry.lookup(PluginKind::sequence_planner, "best_order") == nullptr))
    return sequence;
  look_upwards(sequence);
  return wrapped ? sequence : PluginChoice{"best_order", {{"of", std::move(sequence)}}, {}};
}

}  // namespace

Eigen::Vector3d up_of(const LayoutOptions& layout, const Assembly& assembly) {
  return layout.up == "auto" ? input_frame(assembly).up : layout.up_axis();
}

Objective objective_of(const RunConfig& config, const Registry& registry, const Eigen::Vector3d& up) {
  Objective out;
  out.up = up;
  for (const PluginChoice& choice : checks_of(config, registry)) {
    const ObjectiveOptions options = Schema<ObjectiveOptions>().bind(choice.options);
    out.items.push_back({choice.type, registry.create<StepCheck>(choice.type, choice.parameters), options.weight,
                         options.require, choice.parameters});
  }
  return out;
}

PlanningSetup planning_setup_of(const RunConfig& config, const Registry& registry, const Eigen::Vector3d& up) {
  PlanningSetup out;
  out.simulator = registry.create<Simulator>(config.simulator.type, config.simulator.parameters);
  out.path_planner = [&registry, choice = config.path_planner] {
    return registry.create<PathPlanner>(choice.type, choice.parameters);
  };
  out.objective = objective_of(config, registry, up);
  const PluginChoice sequence = with_best_order(config, registry, out.objective, with_last_resort(config, registry));
  out.sequence_planner = registry.create<SequencePlanner>(sequence.type, sequence.parameters);
  out.path_planner_id = config.path_planner.type;
  out.sequence_planner_id = config.sequence_planner.type;
  if (config.layout.enabled) {
    out.transfer_planner = [&registry, choice = config.transfer_planner] {
      return registry.create<TransferPlanner>(choice.type, choice.parameters);
    };
    out.transfer_planner_id = config.transfer_planner.type;
  }
  for (const PluginChoice& choice : config.provers)
    out.provers.push_back({choice.type, registry.create<ImmobilityProver>(choice.type, choice.parameters)});
  return out;
}

RunOptions run_options_of(const RunConfig& config) {
  RunOptions out;
  out.path_timeout = config.run.path_timeout;
  out.path_steps = static_cast<std::uint64_t>(config.run.path_steps);
  out.verify = config.verify;
  out.named_overlap = config.named_overlap;
  out.proofs = config.proofs;
  out.layout = config.layout;
  out.seed = static_cast<std::uint64_t>(config.run.seed);
  out.force = config.run.force;
  return out;
}

}  // namespace dismantle
