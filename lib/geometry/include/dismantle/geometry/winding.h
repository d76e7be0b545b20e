/// Long screw motions in unrolled coordinates, where a point that turns about an axis and advances moves straight.
///
/// Around the axis of a screw motion a point has a radius r, an angle phi and a height z. The motion changes phi, and z
/// in proportion (`pitch`, per rad); r and psi = z - pitch phi stay what they were. So the surface that a triangle
/// sweeps in many turns is no more than the triangle's own (r, psi), for a range of phi.
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

/// Instants between which the motion is one and the same screw motion, in the frame of B.
struct Winding {
  std::size_t begin = 0, end = 0;      ///< instants
  Eigen::Vector3d origin, axis, side;  ///< a point of the axis; unit; unit and square to it: where phi is zero
  double pitch = 0;                    ///< advance along the axis per rad, either sign
  std::vector<double> turned;          ///< rad since `begin`, by instant: grows
  double off = 0;                      ///< largest distance of a point from where the screw takes it, at any time
  double rounding = 0;                 ///< bound on the error of lengths that are computed from coordinates

  double turned_at(std::size_t instant) const { return turned[instant - begin]; }
};

/// Those of at least 1 rad whose points are off the screw by `most_off` at most, one after the other.
std::vector<Winding> windings(const RelativeMotion& motion, double most_off);

/// Where a triangle is, unrolled. Its r and psi lie in the hull of `p`, grown by the slacks.
struct Unrolled {
  std::array<Eigen::Vector2d, 3> p;  ///< (r, psi)
  double below = 0, above = 0;       ///< slack of r
  double beside = 0;                 ///< slack of psi, either way
  double phi_lo = 0, phi_hi = 0;     ///< with slack, in one of its turns
  bool bent = false;                 ///< too near the axis: no more is known than what follows
  double r_lo = 0, r_hi = 0;         ///< with slack
  double z_lo = 0, z_hi = 0;         ///< with slack
};

/// Distances from the axis and heights along it (upwards: the direction of the advance).
struct Ring {
  double r_lo = std::numeric_limits<double>::infinity(), r_hi = 0;
  double z_lo = std::numeric_limits<double>::infinity(), z_hi = -std::numeric_limits<double>::infinity();

  /// All that the triangle passes from the first instant of the winding, where it is at `t`, to the last.
  void add(const Winding& winding, const Corners& t);
};

/// All places that a mesh takes up, unrolled, as a raster of r and psi; each cell tells where along phi it is taken.
/// Threads have equal profiles everywhere: thousands of triangles share a few cells.
class UnrolledMesh {
 public:
  /// Only what comes near `asked`, see Ring. Cells have the width `cell`: what is nearer than two of them counts as
  /// touching. They are wider where there would be too many, and a lead of less than four of them tells nothing.
  UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, const Ring& asked, double cell);

  /// True: proved that the triangle, `moved` at the first instant of the winding (frame of B), meets no triangle of the
  /// mesh from instant `from` to instant `to`. Adds to `cells` how many were looked at.
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
  bool blind_;       // the lead is too small: nothing is proved
  double cell_ = 0;  // along r
  long rows_ = 0, columns_ = 0;
  double phi_lo_, phi_hi_;     // of all of the mesh; phi goes on from turn to turn as psi is brought into [0, lead)
  std::vector<Bits> taken_;    // by row and column
  std::vector<Bits> by_bent_;  // by row: in all of its columns
  std::vector<Bits> in_row_;   // of all columns together
};

}  // namespace dismantle::geometry
