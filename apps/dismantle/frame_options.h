/// The options --unit and --up: properties of the coordinates that the input files do not state.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle::app {

struct FrameOptions {
  std::string unit, up;  ///< empty: as stated in the files
};
void add_frame(CLI::App& command, FrameOptions& options);

/// @throws InputError for an unknown unit.
InputFrame frame_of(const Plan& plan, const FrameOptions& options);

}  // namespace dismantle::app
