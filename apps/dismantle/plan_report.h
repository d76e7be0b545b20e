/// The report of `dismantle plan` at the end of a run.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

/// The exit status.
int status_of(const RunResult& result, const RunContext& context);

/// The object for Console::result().
nlohmann::ordered_json result_json(const RunResult& result, int status, const std::filesystem::path& plan);

/// Names of parts that could not be used, without those that the configuration excludes.
std::vector<std::string> unusable_parts(const Plan& plan);

/// What exit status 1 is about, for scripts: "parts_left", "forced" or "unusable", the gravest of them; null for a plan
/// that does what was asked for.
nlohmann::ordered_json reason_of(const Plan& plan);
/// What a plan was asked for, as plan.json has it: {} for the whole assembly.
nlohmann::ordered_json asked_json(const PlanAsked& asked);

/// Times and search effort; `verbose` adds the planners' own counters.
std::string effort_text(const RunResult& result, bool verbose);

}  // namespace dismantle::app
