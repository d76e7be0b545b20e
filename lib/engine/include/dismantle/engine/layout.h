/// Poses of the parts before assembly: the initial states of Algorithm 3.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/export.h"
#include "dismantle/parameters.h"
#include "dismantle/pose.h"

namespace dismantle {

/// Where parts lie before assembly.
struct LayoutOptions {
  bool enabled = true;  ///< false: assembly steps begin where the disassembly left the parts
  /// What is up: a direction as in direction_named(), or "auto", Y for input from glTF and Z for other input.
  std::string up = "auto";
  double gap = 0.5;  ///< assembly units; least distance between two parts of the layout
  /// By part name, acting on input coordinates, in input units. Other parts are laid out automatically.
  std::map<std::string, Pose> poses;
  /// Declares all but the poses.
  DISMANTLE_API static void describe(Schema<LayoutOptions>& s);
  /// Z for "auto": who knows the files of the input says otherwise. @throws Error when `up` is no direction.
  DISMANTLE_API Eigen::Vector3d up_axis() const;
};

/// Lays boxes out on a plane without rotation; returns a translation for each box.
///
/// The plane is across the axis nearest to `up`, at the lowest level of `taken[0]` as seen with `up` up. Boxes are
/// placed by descending area on the plane (equal ones in order), each at the free position whose centre is nearest to
/// that of taken[0]. On the plane they keep at least `gap` from each other and from `taken`, so that a box lifted
/// straight up touches no other. Depends only on its arguments. `taken` must not be empty.
DISMANTLE_API std::vector<Eigen::Vector3d> lay_out(const std::vector<Aabb>& boxes, const std::vector<Aabb>& taken,
                                                   const Eigen::Vector3d& up, double gap);

}  // namespace dismantle
