#include "dismantle/frame_options.h"

#include "dismantle/geometry/length_unit.h"

namespace dismantle::app {

void add_frame(CLI::App& command, FrameOptions& options) {
  command.add_option("--unit", options.unit, "Unit of the input, if its files name none: mm, m, inch...")
      ->option_text("UNIT");
  command.add_option("--up", options.up, "Axis of the input that points up; default: y for glTF, else z")
      ->option_text("y|z")
      ->check(CLI::IsMember({"y", "z"}));
  add_show_unit(command, options.show_unit);
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
  PlanAssembly assembly = plan.assembly;
  if (!options.unit.empty()) assembly.unit = options.unit;
  InputFrame frame = input_frame(assembly);
  if (!options.up.empty()) frame.y_up = options.up == "y";
  return shown_in(std::move(frame), options.show_unit);
}

}  // namespace dismantle::app
