/// Parts of a motion that are a single screw motion.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/geometry/relative_motion.h"

namespace dismantle::geometry {

/// Range of instants in which the motion is a single screw motion, in the frame of B.
struct Winding {
  std::size_t begin = 0, end = 0;      ///< instants
  Eigen::Vector3d origin, axis, side;  ///< point of the axis; unit; unit, normal to the axis: phi = 0
  double pitch = 0;                    ///< advance along the axis per rad, either sign
  std::vector<double> turned;          ///< rad since `begin`, by instant; ascending
  double off = 0;                      ///< largest distance of a point from its place on the screw motion
  double rounding = 0;                 ///< error bound of lengths computed from coordinates

  double turned_at(std::size_t instant) const { return turned[instant - begin]; }
};

/// Windings of at least 1 rad whose points deviate from the screw by at most `most_off`, in order of time.
std::vector<Winding> windings(const RelativeMotion& motion, double most_off);

}  // namespace dismantle::geometry
