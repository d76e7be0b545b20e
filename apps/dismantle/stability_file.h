/// stability.json: what `dismantle stability -o` writes and `dismantle verify` checks.
#pragma once

#include <filesystem>
#include <string>

#include "console.h"

namespace dismantle::app {

inline constexpr const char* kStabilityFormat = "dismantle.stability";

/// True if a file states the format; a file that cannot be read does not.
bool is_stability_file(const std::filesystem::path& file);

/// Checks the certificate without the solver. `input`: the assembly if it has moved. Returns the exit status.
int verify_stability(const std::filesystem::path& file, const std::string& input, Console& console);

}  // namespace dismantle::app
