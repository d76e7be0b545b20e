/// Long screw motions in unrolled coordinates, in which a point on a screw motion moves along a straight line.
///
/// In cylindrical coordinates about the screw axis, a point has a radius r, an angle phi and a height z. The motion
/// changes phi, and z in proportion to it (`pitch`, per rad); r and psi = z - pitch phi are constant. So the surface
/// that a triangle sweeps in many turns has only the (r, psi) of the triangle itself, for a range of phi.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/row_runs.h"
#include "dismantle/geometry/sweep.h"
#include "dismantle/geometry/triangle_bvh.h"

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

/// A triangle in unrolled coordinates. Its (r, psi) lie in the hull of `p`, grown by the slacks.
struct Unrolled {
  std::array<Eigen::Vector2d, 3> p;  ///< (r, psi)
  double below = 0, above = 0;       ///< slack of r
  double beside = 0;                 ///< slack of psi, both ways
  double phi_lo = 0, phi_hi = 0;     ///< with slack, for one turn
  bool bent = false;                 ///< too near the axis: only the bounds below are known
  double r_lo = 0, r_hi = 0;         ///< with slack
  double z_lo = 0, z_hi = 0;         ///< with slack
};

/// Range of distances from the axis and of heights along it (up: the direction of the advance).
struct Ring {
  double r_lo = std::numeric_limits<double>::infinity(), r_hi = 0;
  double z_lo = std::numeric_limits<double>::infinity(), z_hi = -std::numeric_limits<double>::infinity();

  /// Adds the region that a triangle sweeps during the winding; `t`: its corners at the first instant.
  void add(const Winding& winding, const Corners& t);
};

/// Occupancy of a mesh in unrolled coordinates: a raster of r and psi whose cells store the occupied ranges of phi. A
/// thread has the same profile everywhere, so thousands of its triangles share a few cells.
class UnrolledMesh {
 public:
  /// Enters only the part of the mesh near `asked`. `cell`: cell width; anything closer than two cells counts as
  /// touching. Cells get wider if there would be too many. If the lead is below four cells, nothing is proved.
  UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, const Ring& asked, double cell);

  /// True proves that the triangle meets no triangle of the mesh from instant `from` to instant `to`. `moved`: its
  /// corners at the first instant of the winding, frame of B. Adds the work, in cells looked at, to `cells`.
  bool clear_of(const Corners& moved, std::size_t from, std::size_t to, std::uint64_t& cells) const;

 private:
  using Bits = RowRuns::Bits;
  void extend(const Corners& t, int depth);
  void enter(const Corners& t, int depth);
  bool free(const Corners& t, double from, double to, int depth, std::uint64_t& cells) const;
  template <class Row, class Run>
  bool runs_of(const Unrolled& u, const Row& row, const Run& run) const;
  Bits bits(double lo, double hi) const;
  Bits bits_of_bent(const Unrolled& u, double from, double to) const;
  std::pair<long, long> rows_of(double lo, double hi) const;
  bool near(const Unrolled& u) const {
    return u.r_hi >= ring_.r_lo && u.r_lo <= ring_.r_hi && u.z_hi >= ring_.z_lo && u.z_lo <= ring_.z_hi;
  }

  const Winding& winding_;
  Ring ring_;
  double lead_;      // >= 0
  bool blind_;       // lead too small: nothing is proved
  double cell_ = 0;  // along r
  long rows_ = 0, columns_ = 0;
  double phi_lo_, phi_hi_;     // of the whole mesh; phi continues over turns, as psi is reduced to [0, lead)
  RowRuns taken_;              // by row and column
  bool empty_ = true;          // no triangle is near
  std::vector<Bits> by_bent_;  // by row: triangles near the axis, for all columns
  std::vector<Bits> in_row_;   // by row: union of all columns
};

}  // namespace dismantle::geometry
