/// Where the parts lie before they are put together: the initial states of Algorithm 3.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/aabb.h"
#include "dismantle/pose.h"
#include "dismantle/parameters.h"

namespace dismantle {

/// A direction along an axis.
enum class Up { x, y, z };

/// Where parts lie before they are put together.
struct LayoutOptions {
  bool enabled = true;  ///< false: assembly steps begin where the disassembly left the parts
  Up up = Up::z;        ///< normal of the plane that parts are laid out on
  double gap = 0.5;     ///< assembly units; least distance between two parts of the layout
  /// By part name, acting on input coordinates, in input units. Parts that are not named are laid out by us.
  std::map<std::string, Pose> poses;
  /// Declares all but the poses.
  DISMANTLE_API static void describe(Schema<LayoutOptions>& s);
  Eigen::Vector3d up_axis() const { return Eigen::Vector3d::Unit(static_cast<int>(up)); }
};

/// Lays boxes out on a plane, without turning them: each box gets a shift.
///
/// The plane is the lowest level of `taken[0]` along `up`. The largest box (by area on the plane, of equal ones the
/// first) is placed first; each takes the free place whose middle is nearest to that of taken[0]. Laid out, boxes and
/// `taken` are at least `gap` apart on the plane: whatever is lifted straight up touches none of the others.
/// Depends on nothing but its arguments. `taken` must not be empty.
DISMANTLE_API std::vector<Eigen::Vector3d> lay_out(const std::vector<Aabb>& boxes, const std::vector<Aabb>& taken,
                                                   Up up, double gap);

}  // namespace dismantle
