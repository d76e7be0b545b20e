/// Poses of the parts before assembly: the initial states of Algorithm 3.
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

/// Where parts lie before assembly.
struct LayoutOptions {
  bool enabled = true;  ///< false: assembly steps begin where the disassembly left the parts
  Up up = Up::z;        ///< normal of the plane that parts are laid out on
  double gap = 0.5;     ///< assembly units; least distance between two parts of the layout
  /// By part name, acting on input coordinates, in input units. Other parts are laid out automatically.
  std::map<std::string, Pose> poses;
  /// Declares all but the poses.
  DISMANTLE_API static void describe(Schema<LayoutOptions>& s);
  Eigen::Vector3d up_axis() const { return Eigen::Vector3d::Unit(static_cast<int>(up)); }
};

/// Lays boxes out on a plane without rotation; returns a translation for each box.
///
/// The plane is the lowest level of `taken[0]` along `up`. Boxes are placed by descending area on the plane (equal ones
/// in order), each at the free position whose centre is nearest to that of taken[0]. On the plane they keep at least
/// `gap` from each other and from `taken`, so that a box lifted straight up touches no other. Depends only on its
/// arguments. `taken` must not be empty.
DISMANTLE_API std::vector<Eigen::Vector3d> lay_out(const std::vector<Aabb>& boxes, const std::vector<Aabb>& taken,
                                                   Up up, double gap);

}  // namespace dismantle
