#pragma once

#include <filesystem>

#include "dismantle/plan.h"

namespace dismantle::app {

/// @throws InputError naming the file and what is wrong with it.
Plan read_plan(const std::filesystem::path& file);

}  // namespace dismantle::app
