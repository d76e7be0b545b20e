#include "dismantle/frame_options.h"

namespace dismantle::app {

void add_frame(CLI::App& command, FrameOptions& options) {
  command.add_option("--unit", options.unit, "Unit of the input, if its files name none: mm, m, inch...")
      ->option_text("UNIT");
  command.add_option("--up", options.up, "Axis of the input that points up; default: y for glTF, else z")
      ->option_text("y|z")
      ->check(CLI::IsMember({"y", "z"}));
}

InputFrame frame_of(const Plan& plan, const FrameOptions& options) {
  PlanAssembly assembly = plan.assembly;
  if (!options.unit.empty()) assembly.unit = options.unit;
  InputFrame frame = input_frame(assembly);
  if (!options.up.empty()) frame.y_up = options.up == "y";
  return frame;
}

}  // namespace dismantle::app
