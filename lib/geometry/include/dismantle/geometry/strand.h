/// Is a solid a strand: one section, swept along a curve?
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// A cut square to the strand.
struct StrandStation {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centroid of the cut
  std::vector<Eigen::Vector3d> rim;                  ///< its outline, in order
};

/// A solid as a strand. Lengths in the mesh's unit.
struct Strand {
  std::vector<StrandStation> stations;  ///< along it, half a thickness apart
  bool closed = false;                  ///< it ends where it begins
  double thickness = 0;                 ///< diameter of the circle of the same area, median of the stations
  double length = 0;                    ///< of the line through the centres
  double roundness = 0;                 ///< 4 pi area / outline^2, median of the stations; 1: a circle
  double share = 0;                     ///< of the solid's volume, what the strand has; 1: nothing else is there
  std::vector<double> turns;            ///< rad, by station: how far the line turns there
  /// Length of the sum of all turns as vectors, in full turns: what turns the same way adds up, and what sways does
  /// not.
  double coils = 0;
};

/// Follows the strand from a cut through the surface, as long as the cut keeps its area (within a quarter), is no
/// flatter than a rectangle nearly three times as wide as thick, and is where the cuts before it lead to. None where no
/// such strand of eight thicknesses or more is found. Rotations, scale and triangulation change nothing but rounding.
/// The mesh must be closed and welded.
DISMANTLE_API std::optional<Strand> follow_strand(const Mesh& mesh);

}  // namespace dismantle::geometry
