#include "config/sections.h"

namespace dismantle {
namespace {

struct VerifySettings : VerifyBudget {
  double max_penetration = VerifyOptions{}.max_penetration;
  double named_overlap = 0.1;
  static void describe(Schema<VerifySettings>& s) {
    s.add("max_penetration", &VerifySettings::max_penetration,
          {.unit = "assembly units",
           .min = 0,
           .max = 0.05 * PrepareOptions{}.size,
           .min_open = true,
           .doc = "Deepest penetration allowed along a path, beyond the overlap of the pair. The largest edge of the "
                  "assembly is 10; with more than a twentieth of that, parts could pass through each other's walls, "
                  "and a valid plan would mean nothing."});
    s.add(
        "named_overlap", &VerifySettings::named_overlap,
        {.unit = "assembly units",
         .min = 0,
         .doc = "Pairs that overlap by more than this when assembled are named in each step of the plan that uses the "
                "overlap, with the depth along the path."});
    s.advanced("tests", &VerifyBudget::tests, {1, 1e12});
    s.advanced("tests_per_segment", &VerifyBudget::tests_per_segment, {0, 1e12});
    s.advanced("patches", &VerifyBudget::patches, {4, 1e9});
    s.advanced("overlap_factor", &VerifyBudget::overlap_factor, {1, 1000});
    s.advanced("trial_share", &VerifyBudget::trial_share, {.min = 0, .max = 1, .min_open = true});
    s.advanced("resolution", &VerifyBudget::resolution, {.min = 0, .max = 1, .min_open = true});
  }
};

}  // namespace

void bind_verify_section(RunConfig& config) {
  const auto v = Schema<VerifySettings>().bind(config.sections.at("verify"));
  config.verify.max_penetration = v.max_penetration;
  config.verify.budget = v;
  config.named_overlap = v.named_overlap;
}

void RunSettings::describe(Schema<RunSettings>& s) {
  s.add("seed", &RunSettings::seed, {.unit = "1", .min = 0, .doc = "Seed of every random choice."});
  s.add(
      "threads", &RunSettings::threads,
      {.unit = "1", .min = 0, .max = 1024, .doc = "Number of threads; 0 = all cores. The plan does not depend on it."});
  s.add("path_timeout", &RunSettings::path_timeout,
        {.unit = "s", .min = 0, .doc = "Time limit for one attempt to remove parts; 0 = no limit."});
  s.add("path_steps", &RunSettings::path_steps,
        {.unit = "1",
         .min = 0,
         .doc = "Limit of simulated time steps for one attempt; 0 = no limit. Unlike seconds, it is the same on every "
                "machine."});
  s.add("timeout", &RunSettings::timeout,
        {.unit = "s", .min = 0, .doc = "Time limit for the whole run; 0 = no limit."});
  s.add_choice<ForceWhen>(
      "force", &RunSettings::force,
      {{"off", ForceWhen::off, "parts that no verified path was found for stay"},
       {"last_resort", ForceWhen::last_resort,
        "they are taken out where they cut in least, in steps that are marked as forced and never count as verified"}},
      "What is done with parts that no verified path was found for. Benchmarks never force.");
  s.add("best_order", &RunSettings::best_order,
        {.doc = "Put the sequence planner into a `best_order`, unless it is one or the objective is empty: its plan is "
                "then put in the order that the objective likes best. Off: the objective judges the plan, no more."});
  s.add(
      "grace", &RunSettings::grace,
      {.unit = "s",
       .min = 0,
       .doc =
           "Time that plugins have for stopping after the time limit or Ctrl-C; then the plan so far is saved and the "
           "process ends with status 4. 0 = wait without limit."});
}

const std::vector<std::pair<std::string, std::vector<ParamSpec>>>& fixed_sections() {
  static const std::vector<std::pair<std::string, std::vector<ParamSpec>>> sections = {
      {"assembly", Schema<PrepareOptions>().specs()},
      {"layout", Schema<LayoutOptions>().specs()},
      {"run", Schema<RunSettings>().specs()},
      {"verify", Schema<VerifySettings>().specs()}};
  return sections;
}

namespace {

ParamSet weight_of(double weight) { return {{"weight", weight}}; }

}  // namespace

const std::vector<PluginSection>& plugin_sections() {
  static const std::vector<PluginSection> sections = {
      {"simulator", PluginKind::simulator, {"sdf_penalty"}, &RunConfig::simulator},
      {"path_planner", PluginKind::path_planner, {"guided"}, &RunConfig::path_planner},
      {"sequence_planner", PluginKind::sequence_planner, {"blocking"}, &RunConfig::sequence_planner},
      {"transfer_planner", PluginKind::transfer_planner, {"rrt_connect"}, &RunConfig::transfer_planner},
      {.name = "immobility",
       .kind = PluginKind::immobility_prover,
       .defaults = {"overlap_lock", "enclosed_ball", "ring", "spool", "hook", "disc", "configuration_cells",
                    "interlock_lp", "translations"},
       .many = &RunConfig::provers,
       .list = "provers",
       .doc = "Immobility provers, in the order in which they are asked; [] = none.",
       .beside = Schema<ProofOptions>().specs()},
      {.name = "objective",
       .kind = PluginKind::step_check,
       .defaults = {"directions", "identical_parts", "gravity", "reorientations", "tool_access"},
       .many = &RunConfig::objective,
       .doc = "Step checks that judge each step as an assembly operation; [] = any order without collisions is as good "
              "as another.",
       .options = Schema<ObjectiveOptions>().specs(),
       .default_options = {weight_of(1), weight_of(0.3), weight_of(1), weight_of(1.5), weight_of(1)}}};
  return sections;
}

void ObjectiveOptions::describe(Schema<ObjectiveOptions>& s) {
  s.add("weight", &ObjectiveOptions::weight, {.unit = "1", .min = 0, .doc = "Factor on the cost of this check."});
  s.add("require", &ObjectiveOptions::require, {.doc = "A step that the check does not allow is refused."});
}

ParamSpec plugin_list(const PluginSection& section, const Registry& registry) {
  ParamSpec spec;
  spec.name = section.list.empty() ? section.name : section.list;
  spec.type = ParamType::plugins;
  spec.plugin_kind = section.kind;
  spec.options = section.options;
  spec.may_be_empty = true;
  spec.doc = section.doc;
  std::vector<PluginChoice> fallback;
  for (std::size_t k = 0; k < section.defaults.size(); ++k)
    if (registry.lookup(section.kind, section.defaults[k]) != nullptr)
      fallback.push_back({section.defaults[k], {}, section.default_options.empty() ? ParamSet{} : section.default_options[k]});
  spec.fallback = std::move(fallback);
  return spec;
}

std::vector<ParamSpec> list_section(const PluginSection& section, const Registry& registry) {
  std::vector<ParamSpec> all = {plugin_list(section, registry)};
  all.insert(all.end(), section.beside.begin(), section.beside.end());
  return all;
}

std::vector<PluginChoice> default_list(std::vector<PluginChoice> RunConfig::*list, const Registry& registry) {
  for (const PluginSection& section : plugin_sections())
    if (section.many == list) return std::get<std::vector<PluginChoice>>(plugin_list(section, registry).fallback);
  return {};
}

}  // namespace dismantle
