/// What `dismantle plan` says of a run when it is over.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

/// The exit status. `constrained`: the outcome says whether all was done that the constraints leave to do.
int status_of(const RunResult& result, const Assembly& assembly, bool one_part, bool constrained,
              const RunContext& context);

/// What Console::result() prints.
nlohmann::ordered_json result_json(const RunResult& result, const Assembly& assembly, int status,
                                   const std::filesystem::path& plan);

/// Times and what was searched; the planners' own counters are for `verbose`.
std::string effort_text(const RunResult& result, bool verbose);

}  // namespace dismantle::app
