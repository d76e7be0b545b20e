#include "frame_options.h"

#include "dismantle/geometry/direction.h"
#include "dismantle/geometry/length_unit.h"

namespace dismantle::app {

void add_frame(CLI::App& command, FrameOptions& options) {
  command.add_option("--unit", options.unit, "Unit of the input, if its files name none: mm, m, inch...")
      ->option_text("UNIT");
  add_up(command, options.up, "What is up in the input's coordinates; default: as in the plan");
  add_show_unit(command, options.show_unit);
}

CLI::Option* add_up(CLI::App& command, std::string& up, const std::string& help) {
  return command.add_option("--up", up, help)
      ->option_text("x|y|z|-x|-y|-z|X,Y,Z")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return direction_named(text) ? "" : "'" + text + "' is no direction; write " + kDirectionForms;
          },
          "DIRECTION"));
}

void add_show_unit(CLI::App& command, std::string& show_unit) {
  command
      .add_option("--show-unit", show_unit,
                  "Unit of lengths in texts and lists: mm, inch...; default: that of the input, mm for small metres")
      ->option_text("UNIT")
      ->check(CLI::Validator(
          [](const std::string& unit) {
            return unit_named(unit).empty()
                       ? "'" + unit + "' is no unit of length here: um, mm, cm, dm, m, km, mil, inch, foot, mile"
                       : "";
          },
          "UNIT"));
}

InputFrame frame_of(const Plan& plan, const FrameOptions& options) {
  InputFrame frame = input_frame(plan);
  if (!options.unit.empty()) {
    PlanAssembly assembly = plan.assembly;
    assembly.unit = options.unit;
    const Eigen::Vector3d up = frame.up;
    frame = input_frame(assembly);
    frame.up = up;
  }
  if (!options.up.empty()) frame.up = direction_named(options.up).value();
  return shown_in(std::move(frame), options.show_unit);
}

}  // namespace dismantle::app
