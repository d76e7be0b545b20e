/// Length unit and up axis of an assembly's input, for conversion to glTF (metres, Y up).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Unit and axes of the input.
struct InputFrame {
  std::string unit;         ///< "mm", "inch"...
  bool unit_known = false;  ///< false: the files name none, and `unit` is the usual one of CAD, "mm" (of glTF: "m")
  double metres = 1e-3;     ///< per input unit, > 0
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit; Y for input from glTF; all else counts as Z up, as in CAD
  std::string shown{};                            ///< unit in which texts state lengths; empty: the one that people use

  /// Turns input axes to those of glTF.
  Eigen::Quaterniond to_y_up() const;
  /// How an assembly lies in a step that states its `up` (unit): turned from how it is drawn. None: not turned.
  Eigen::Quaterniond lies(const std::optional<Eigen::Vector3d>& upwards) const;
};

/// Turns the direction `up` (unit) to Z by the shortest way; -Z over the front, so that right stays right. In the
/// turned frame right is X and back is Y.
DISMANTLE_API Eigen::Quaterniond upright(const Eigen::Vector3d& up);

/// Unit in which texts state lengths, and how many of it one input unit is.
struct TextUnit {
  std::string name;
  double factor = 1;
};

/// unit_for_people() for an input of this box; `unit` itself when it is empty or not known.
DISMANTLE_API TextUnit text_unit(const std::string& unit, const Aabb& box);

/// The unit that the frame asks for, else that of people for an input of this box; of an input without a known unit the
/// unit is called `unknown`.
DISMANTLE_API TextUnit text_unit(const InputFrame& frame, const Aabb& box, const std::string& unknown = "units");

/// The same frame with lengths shown in `unit` (any of its usual names; empty: no change).
/// @throws InputError for an unknown unit, and when the unit of the input is not known.
DISMANTLE_API InputFrame shown_in(InputFrame frame, const std::string& unit);

/// @throws InputError as metres_in().
DISMANTLE_API InputFrame input_frame(const Assembly& assembly);
/// Unit and up direction of the files that a plan is for.
DISMANTLE_API InputFrame input_frame(const PlanAssembly& assembly);
/// The same; up is how the assembly lies by the plan's objective, if it was judged by one.
DISMANTLE_API InputFrame input_frame(const Plan& plan);

}  // namespace dismantle
