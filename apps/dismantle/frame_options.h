/// The options --unit and --up, properties of the coordinates that the input files do not state, and --show-unit.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle::app {

struct FrameOptions {
  std::string unit, up;   ///< empty: as stated in the files
  std::string show_unit;  ///< empty: the one that people use
};
void add_frame(CLI::App& command, FrameOptions& options);
/// --up: a direction as in direction_named(), checked.
CLI::Option* add_up(CLI::App& command, std::string& up, const std::string& help);
void add_show_unit(CLI::App& command, std::string& show_unit);

/// @throws InputError for an unknown unit.
InputFrame frame_of(const Plan& plan, const FrameOptions& options);

}  // namespace dismantle::app
