#include "suite/problem.h"

#include <fmt/format.h>

#include <algorithm>

namespace dismantle::bench {

bool is_for_all(std::string_view key) {
  const std::string_view section = key.substr(0, key.find('.'));
  return key != "assembly.subdivide" && (section == "verify" || std::ranges::count(kForAll, section) > 0);
}

std::string belongs_to_the_suite(std::string_view section) {
  return fmt::format(
      "{} of one planner would make the trials of the others another task; the suite has them for all: "
      "write '{}:' at its top level",
      section, section);
}

Problem problem_of(const ConfigNode& suite, double max_penetration) {
  ConfigSource source;
  if (const auto* member = suite.find("assembly")) source.sections.push_back(*member);
  Registry registry;
  Problem problem = load_config(source, registry).sections;
  const double size = std::get<double>(problem.at("assembly").at("size")) / 10;
  problem.at("verify").at("max_penetration") = max_penetration * size;
  return problem;
}

void give_problem(const Problem& problem, const SuitePlanner& planner, ConfigSource& source,
                  std::vector<std::string>& notes) {
  for (const auto& [section, specs] : fixed_sections()) {
    if (!is_for_all(section) || !problem.contains(section)) continue;
    for (const ParamSpec& spec : specs) {
      const std::string key = section + "." + spec.name;
      const ParamValue& own = planner.config.sections.at(section).at(spec.name);
      const ParamValue& all = problem.at(section).at(spec.name);
      if (!is_for_all(key) || own == all) continue;
      source.options.push_back({section, key, to_text(all)});
      if (own != spec.fallback)
        notes.push_back(fmt::format("planners.{}: {} is {} for all planners of the suite, not {} as in its file",
                                    planner.name, key, to_text(all), to_text(own)));
    }
  }
}

std::optional<Diagnostic> own_section(const SuitePlanner& planner) {
  const RunConfig& config = planner.config;
  const auto refusal = [&](Diagnostic place, std::string_view section) {
    place.message = fmt::format("planners.{}: {}", planner.name, belongs_to_the_suite(section));
    return place;
  };
  if (!config.constraint_names.empty()) return refusal(config.constraint_names.front().place, "constraints");
  if (!config.component_names.empty()) return refusal(config.component_names.front().place, "components");
  for (const auto& [importer, values] : import_params_of(config, *planner.registry))
    if (!values.empty())
      return refusal({config.origins.at(fmt::format("importers.{}.{}", importer, values.begin()->first)), 0, 0, ""},
                     "importers");
  return {};
}

}  // namespace dismantle::bench
