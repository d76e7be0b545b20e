/// What is to be solved: the parts of a configuration that a suite has for all its planners.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/bench/suite.h"
#include "dismantle/host/config.h"
#include "dismantle/host/config_bind.h"

namespace dismantle::bench {

/// Sections of a suite that are merged into the configuration of each planner.
inline constexpr std::array<std::string_view, 5> kForAll = {"assembly", "components", "constraints", "importers",
                                                            "parts"};

/// Whether the key of a configuration belongs to the suite. How finely surfaces are sampled is a planner's own.
bool is_for_all(std::string_view key);

/// Why a planner may not have this section.
std::string belongs_to_the_suite(std::string_view section);

/// Values of the sections `assembly` and `verify`, by section.
using Problem = std::map<std::string, ParamSet>;

/// `max_penetration`: for an assembly of size 10. @throws ConfigError for the suite's section `assembly`.
Problem problem_of(const ConfigNode& suite, double max_penetration);

/// Overrides what differs in the planner's own file; a note says so unless it is a default there.
void give_problem(const Problem& problem, const SuitePlanner& planner, ConfigSource& source,
                  std::vector<std::string>& notes);

/// An error if the planner's file has constraints, components or importers.
std::optional<Diagnostic> own_section(const SuitePlanner& planner);

}  // namespace dismantle::bench
