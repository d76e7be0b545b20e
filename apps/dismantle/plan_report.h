/// The report of `dismantle plan` at the end of a run.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

/// The exit status. `constrained`: the outcome decides whether everything that the constraints allow was done.
int status_of(const RunResult& result, const Assembly& assembly, bool one_part, bool constrained,
              const RunContext& context);

/// The object for Console::result().
nlohmann::ordered_json result_json(const RunResult& result, const Assembly& assembly, int status,
                                   const std::filesystem::path& plan);

/// Times and search effort; `verbose` adds the planners' own counters.
std::string effort_text(const RunResult& result, bool verbose);

}  // namespace dismantle::app
