/// Detects solids that are strands: one section, swept along a curve.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// A cut perpendicular to the strand.
struct StrandStation {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centroid of the cut
  std::vector<Eigen::Vector3d> rim;                  ///< its outline, in order
};

/// A solid as a strand. Lengths in the mesh's unit.
struct Strand {
  std::vector<StrandStation> stations;  ///< along the strand, half a thickness apart
  bool closed = false;                  ///< it ends where it begins
  double thickness = 0;                 ///< diameter of the circle of the same area, median of the stations
  double length = 0;                    ///< of the line through the station centres
  double roundness = 0;                 ///< 4 pi area / outline^2, median of the stations; 1: a circle
  double share = 0;                     ///< of the solid's volume that the strand takes up; 1: nothing else
  std::vector<double> turns;            ///< rad, by station: turn of the line
  /// Norm of the vector sum of all turns, in full turns: turns in the same sense add up, alternating turns cancel.
  double coils = 0;
};

/// Follows the strand from a cut through the solid. It continues while the cut keeps its area (within a quarter), is no
/// flatter than a 3:1 rectangle (nearly), and lies where the previous cuts lead. None if no strand of at least eight
/// thicknesses is found. Rotation, scale and triangulation change only rounding. The mesh must be closed and welded.
DISMANTLE_API std::optional<Strand> follow_strand(const Mesh& mesh);

}  // namespace dismantle::geometry
