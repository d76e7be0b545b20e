/// Helical sweeps in unrolled coordinates, in which a point on a screw motion moves along a straight line.
///
/// Relative to the axis of a screw motion a point has a radius r, an angle phi and a height z. The motion changes phi,
/// and z in proportion (`pitch`, per rad); r and psi = z - pitch phi are constant. So the surface that a triangle
/// sweeps in many turns is the triangle's own set of (r, psi), for a range of phi.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/sweep.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::geometry {

/// A helical segment: instants between which the motion is one and the same screw motion, in the frame of B.
struct Winding {
  std::size_t begin = 0, end = 0;      ///< instants
  Eigen::Vector3d origin, axis, side;  ///< a point of the axis; unit; unit and square to it: where phi is zero
  double pitch = 0;                    ///< advance along the axis per rad, either sign
  std::vector<double> turned;          ///< rad since `begin`, by instant: grows
  double off = 0;                      ///< bound of the distance of a point from its position on the screw, at any time

  double turned_at(std::size_t instant) const { return turned[instant - begin]; }
};

/// The long helical segments of a motion, in order.
std::vector<Winding> windings(const RelativeMotion& motion);

/// A triangle in unrolled coordinates. Its r and psi lie in the convex hull of `p`, enlarged by the slacks.
struct Unrolled {
  std::array<Eigen::Vector2d, 3> p;  ///< (r, psi)
  double below = 0, above = 0;       ///< slack of r
  double beside = 0;                 ///< slack of psi, either way
  double phi_lo = 0, phi_hi = 0;     ///< with slack, in one of its turns
  bool bent = false;                 ///< too near the axis: only the bounds below are valid
  double r_lo = 0, r_hi = 0;         ///< with slack
  double z_lo = 0, z_hi = 0;         ///< with slack
};

/// A range of distances from the axis and of heights along it (upwards: the direction of the advance).
struct Ring {
  double r_lo = std::numeric_limits<double>::infinity(), r_hi = 0;
  double z_lo = std::numeric_limits<double>::infinity(), z_hi = -std::numeric_limits<double>::infinity();

  /// Adds all positions of the triangle from the first instant of the winding, where it is at `t`, to the last.
  void add(const Winding& winding, const Corners& t);
};

/// The points of a mesh in unrolled coordinates, as a raster of r and psi; each cell stores the occupied ranges of phi.
/// The profile of a thread is the same all along it, so thousands of triangles share a few cells.
class UnrolledMesh {
 public:
  /// Only triangles near `asked` are entered. Cells are `cell` wide (assembly units). Triangles closer than two cells
  /// count as touching.
  UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, const Ring& asked, double cell);

  /// True: proved that the triangle, `moved` at the first instant of the winding (frame of B), meets no triangle of the
  /// mesh from instant `from` to instant `to`. Adds the number of visited cells to `cells`.
  bool clear_of(const Corners& moved, std::size_t from, std::size_t to, std::uint64_t& cells) const;

 private:
  using Bits = std::array<std::uint64_t, 2>;
  void extend(const Corners& t, int depth);
  void enter(const Corners& t, int depth);
  bool free(const Corners& t, double from, double to, int depth, std::uint64_t& cells) const;
  template <class Row, class Cell>
  bool cells_of(const Unrolled& u, const Row& row, const Cell& cell) const;
  Bits bits(double lo, double hi) const;
  Bits bits_of_bent(const Unrolled& u, double from, double to) const;
  std::pair<long, long> rows_of(double lo, double hi) const;
  bool near(const Unrolled& u) const {
    return u.r_hi >= ring_.r_lo && u.r_lo <= ring_.r_hi && u.z_hi >= ring_.z_lo && u.z_lo <= ring_.z_hi;
  }

  const Winding& winding_;
  Ring ring_;
  double lead_;      // >= 0
  double cell_ = 0;  // along r
  long rows_ = 0, columns_ = 0;
  double phi_lo_, phi_hi_;     // of all of the mesh; phi goes on from turn to turn as psi is brought into [0, lead)
  std::vector<Bits> taken_;    // by row and column
  std::vector<Bits> by_bent_;  // by row: in all of its columns
  std::vector<Bits> in_row_;   // of all columns together
};

}  // namespace dismantle::geometry
