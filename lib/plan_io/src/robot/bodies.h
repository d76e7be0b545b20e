/// The parts of a plan as rigid bodies of a robot's model: names, meshes, masses.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/robot_exports.h"
#include "dismantle/pose.h"

namespace dismantle {

/// From input units and axes to metres with Z up.
class RobotFrame {
 public:
  explicit RobotFrame(const InputFrame& frame) : metres_(frame.metres), turn_(upright(frame.up)) {}
  Eigen::Vector3d point(const Eigen::Vector3d& input) const { return metres_ * (turn_ * input); }
  Pose pose(const Pose& input) const { return {point(input.t), turn_ * input.q * turn_.conjugate()}; }
  double metres() const { return metres_; }

 private:
  double metres_;
  Eigen::Quaterniond turn_;
};

/// SI units, in the frame of the assembly.
struct RobotBody {
  std::string part;  ///< its name in the plan
  std::string link;  ///< unique: letters, digits, '_', '-', '.'
  std::string mesh;  ///< "lid.obj"
  bool open = false;
  std::optional<Rgba> colour{};
  double mass = 0;                                        ///< kg
  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about `center`
};

/// In the order of PlanAssembly::parts. A part without a density counts as 1 g/cm3. An open part, or one without
/// volume, has the mass of its surface at a hundredth of its diagonal as thickness, and the inertia of its box.
/// @throws InputError when the plan has a part that the assembly lacks.
std::vector<RobotBody> robot_bodies(const Plan& plan, const Assembly& assembly, const RobotFrame& frame);

/// `meshes/NAME.obj` for every body, assembled.
std::vector<ExportedFile> mesh_files(const std::vector<RobotBody>& bodies, const Assembly& assembly,
                                     const RobotFrame& frame);

/// "1 0 0.5".
std::string numbers_text(const Eigen::VectorXd& numbers);
/// "0.2 0.2 1 1".
std::string rgba_text(const Rgba& colour);

}  // namespace dismantle
