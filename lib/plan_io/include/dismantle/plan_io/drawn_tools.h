/// Tools in their place, as the notes of a plan describe them: pages and books draw them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/plan.h"

namespace dismantle {

/// An upright prism, in millimetres, in the frame of its tool.
struct ToolPrism {
  std::vector<Eigen::Vector2d> outline;  ///< convex, counter-clockwise
  double inner = 0;                      ///< radius of a hole about the axis; 0: none
  double low = 0, high = 0;              ///< along the axis
};

/// A tool on its fastener, at the end of an assembly operation.
struct DrawnTool {
  std::string part;   ///< that it is on
  std::string name;   ///< "hex key 2.5"
  bool turns = true;  ///< false: it holds the other end
  Eigen::Vector3d origin, axis,
      x;              ///< input coordinates; `axis` points away from the fastener, `x` to the handle; unit
  double mm = 1;      ///< millimetres in an input unit
  double swing = 0;   ///< rad; 0: it turns in itself
  double travel = 0;  ///< mm that it follows the fastener along the axis
  std::vector<ToolPrism> tool, hand;
};

/// Of one step, from the notes `tool_access.tool`. Notes of another form are left out: any check may write notes.
DISMANTLE_API std::vector<DrawnTool> drawn_tools(const std::vector<PlanVerdict>& checks);

/// The surface of prisms of a tool in its place, input coordinates.
DISMANTLE_API Mesh mesh_of(const DrawnTool& tool, const std::vector<ToolPrism>& prisms);

}  // namespace dismantle
