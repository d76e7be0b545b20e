/// A plan for simulators and robots: a folder with a model, meshes and the motions. Metres, kilograms, seconds, Z up.
/// The frame of every part coincides with the frame of the assembly when assembled, so that its pose is that of
/// plan.json in other units.
#pragma once

#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

/// A file of an export that writes several.
struct ExportedFile {
  std::string name;  ///< relative to the folder, with '/'
  std::string content;
};

/// MuJoCo: `assembly.xml`, and `meshes/*.obj`. A body with a free joint for each part, a weld for each piece that a
/// step takes off (`step_N_...`), a keyframe for the state after each step of the disassembly (docs/exports.md).
/// @throws InputError when the plan does not belong to the assembly.
DISMANTLE_API std::vector<ExportedFile> to_mjcf(const Plan& plan, const Assembly& assembly, const InputFrame& frame);

/// ROS 2: `assembly.urdf` with a link and a floating joint for each part, `meshes/*.obj`, and `motions.json` with
/// the steps in the fields of geometry_msgs and trajectory_msgs; format "dismantle.ros" (docs/exports.md).
/// @throws InputError as to_mjcf().
DISMANTLE_API std::vector<ExportedFile> to_ros(const Plan& plan, const Assembly& assembly, const InputFrame& frame);

}  // namespace dismantle
