#include "dismantle/host/config.h"

namespace dismantle {
namespace {

struct VerifySettings {
  double max_penetration = VerifyOptions{}.max_penetration;
  double named_overlap = 0.1;
  static void describe(Schema<VerifySettings>& s) {
    s.add(
        "max_penetration", &VerifySettings::max_penetration,
        {.unit = "assembly units",
         .min = 0,
         .max = 0.05 * PrepareOptions{}.size,
         .min_open = true,
         .doc = "Deepest penetration that a path may have, above what the pair had when assembled. The largest edge of "
                "the assembly is 10; at more than a twentieth of it parts pass through each other's walls, and that a "
                "plan is valid says nothing."});
    s.add("named_overlap", &VerifySettings::named_overlap,
          {.unit = "assembly units",
           .min = 0,
           .doc = "Pairs that overlap by more than this when assembled are named in each step of the plan that makes "
                  "use of it, with the depth along the way."});
  }
};

}  // namespace

void RunSettings::describe(Schema<RunSettings>& s) {
  s.add("seed", &RunSettings::seed, {.unit = "1", .min = 0, .doc = "Seed of every random choice."});
  s.add("threads", &RunSettings::threads,
        {.unit = "1",
         .min = 0,
         .max = 1024,
         .doc = "Threads to plan with; 0 = all cores. The plan does not depend on it."});
  s.add("path_timeout", &RunSettings::path_timeout,
        {.unit = "s", .min = 0, .doc = "Time for one attempt to take one part out; 0 = no limit."});
  s.add("path_steps", &RunSettings::path_steps,
        {.unit = "1",
         .min = 0,
         .doc = "Simulated time steps for one attempt; 0 = no limit. Unlike seconds, the same on every machine."});
  s.add("timeout", &RunSettings::timeout, {.unit = "s", .min = 0, .doc = "Time for the whole run; 0 = no limit."});
  s.add_choice<ForceWhen>(
      "force", &RunSettings::force,
      {{"off", ForceWhen::off, "parts that no verified path was found for stay"},
       {"last_resort", ForceWhen::last_resort,
        "they are taken out where they cut in least, in steps that are marked as forced and never count as verified"}},
      "What is done with parts that no verified path was found for. Benchmarks never force.");
  s.add(
      "grace", &RunSettings::grace,
      {.unit = "s",
       .min = 0,
       .doc =
           "Time that plugins have to end after the run's time is up or Ctrl-C; then the plan so far is saved and the "
           "process ends with status 4. 0 = wait without limit."});
}

const std::vector<std::pair<std::string, std::vector<ParamSpec>>>& fixed_sections() {
  static const std::vector<std::pair<std::string, std::vector<ParamSpec>>> sections = {
      {"assembly", Schema<PrepareOptions>().specs()},
      {"layout", Schema<LayoutOptions>().specs()},
      {"run", Schema<RunSettings>().specs()},
      {"force", Schema<ForceOptions>().specs()},
      {"verify", Schema<VerifySettings>().specs()}};
  return sections;
}

const std::vector<PluginSection>& plugin_sections() {
  static const std::vector<PluginSection> sections = {
      {"simulator", PluginKind::simulator, "sdf_penalty"},
      {"path_planner", PluginKind::path_planner, "guided"},
      {"sequence_planner", PluginKind::sequence_planner, "blocking"},
      {"transfer_planner", PluginKind::transfer_planner, "rrt_connect"}};
  return sections;
}

}  // namespace dismantle
