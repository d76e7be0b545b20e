/// Requests and inputs of a trial.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "dismantle/bench/trial.h"
#include "dismantle/bench/trial_row.h"
#include "dismantle/preparation/read_input.h"

namespace dismantle::bench {

/// @throws InputError naming the file.
nlohmann::json read_json(const std::filesystem::path& file);
TrialRequest read_request(const std::filesystem::path& folder);

/// Writes the columns that are set.
void write_result(const TrialResult& result, const std::filesystem::path& folder);
/// Sets the columns that the planning process has written. @throws InputError, nlohmann::json::exception.
void read_result(const std::filesystem::path& folder, TrialResult& result);

/// The path of the trial's assembly. A generated one (a sample, a rotated one, one with a `translation.json`) is made
/// once and kept; several processes may do so concurrently. `read` gives the parts of an input. @throws InputError.
std::filesystem::path input_of(const TrialRequest& request,
                               const std::function<InputParts(const std::filesystem::path&)>& read);

/// True for a folder that holds a `translation.json`. In this layout of the paper's data, the vector named NAME moves
/// part NAME.obj to its assembled position.
bool has_offsets(const std::filesystem::path& input);

}  // namespace dismantle::bench
