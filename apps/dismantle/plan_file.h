#pragma once

#include <filesystem>
#include <string>

#include "dismantle/plan.h"

namespace dismantle::app {

/// @throws InputError naming the file and the problem.
Plan read_plan(const std::filesystem::path& file);

/// The input of a plan: `named` unless it is empty, else the path in the plan, relative to the working directory or to
/// the plan file. @throws InputError when there is no such file.
std::string source_of(const Plan& plan, const std::filesystem::path& file, const std::string& named);

}  // namespace dismantle::app
