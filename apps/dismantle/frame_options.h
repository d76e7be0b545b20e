/// The options --unit and --up: what the files of an input do not say about its coordinates.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle::app {

struct FrameOptions {
  std::string unit, up;  ///< empty: as the files say
};
void add_frame(CLI::App& command, FrameOptions& options);

/// @throws InputError for a unit that is not known.
InputFrame frame_of(const Plan& plan, const FrameOptions& options);

}  // namespace dismantle::app
