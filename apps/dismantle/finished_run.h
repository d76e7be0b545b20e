/// The record of a finished run of `plan --each`, by which a later one with the same input and settings is spared.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "dismantle/run_context.h"
#include "dismantle/session/session.h"

namespace dismantle::app {

/// The file beside plan.json.
inline constexpr const char* kFinishedRun = "finished.json";

struct FinishedRun {
  int status = 0;  ///< exit status
  nlohmann::ordered_json result;
};

/// Records a run that came to its own end.
void write_finished(const std::filesystem::path& folder, int status, const nlohmann::ordered_json& result);

/// The run that has been recorded in `folder`, if its plan is of the bytes that `input` has now and of the settings of
/// the session. The number of threads may differ, because no plan depends on it.
/// @throws InputError, Error as Session::read().
std::optional<FinishedRun> finished_run(const std::filesystem::path& folder, const std::string& input,
                                        const Session& session, const RunContext& context);

}  // namespace dismantle::app
