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
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "dismantle/geometry/row_runs.h"
#include "dismantle/geometry/sweep.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/geometry/winding.h"

namespace dismantle::geometry {

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

  /// Adds the region that a triangle sweeps between two instants of the winding; `t`: its corners at the first instant
  /// of the winding.
  void add(const Winding& winding, const Corners& t, std::size_t from, std::size_t to);
};

/// Cells of r, in rows, and of psi reduced to [0, lead), in columns.
struct UnrolledRaster {
  /// Numbers of full turns.
  struct Turns {
    long first, last;
    bool operator==(const Turns&) const = default;
  };
  double r_lo = 0, cell = 0, lead = 0;
  double rounding = 0;  ///< of the winding
  long rows = 0, columns = 0;

  UnrolledRaster() = default;
  UnrolledRaster(const Ring& ring, double lead, double rounding, double cell);
  /// First and last row that [lo, hi] overlaps.
  std::pair<long, long> rows_of(double lo, double hi) const;
  /// Calls f(row, first, last, turns) for all runs of cells that the triangle may overlap; `turns`: the numbers of full
  /// turns by which it is wound back there, first and last. Returns false as soon as f does. Skips rows with false
  /// in_row(row).
  template <class Row, class Run>
  bool runs_of(const Unrolled& u, const Row& in_row, const Run& f) const;
};

/// Occupancy of a mesh in unrolled coordinates: a raster of r and psi whose cells store the occupied ranges of phi. A
/// thread has the same profile everywhere, so thousands of its triangles share a few cells. It is made for some moving
/// triangles, and holds what these may meet: mostly a small share of the mesh.
class UnrolledMesh {
 public:
  /// `asked`: corners at the first instant of the winding, frame of B; asked about are the instants `from` to `to`.
  /// `cell`: cell width; anything closer than two cells counts as touching. Cells get wider if there would be too many.
  /// If the lead is below four cells, nothing is proved.
  UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, std::span<const Corners> asked, std::size_t from,
               std::size_t to, double cell);

  /// True proves that the triangle, one of those asked, meets no triangle of the mesh from instant `from` to instant
  /// `to`, which are among those asked about. Adds the work, in cells looked at, to `cells`.
  bool clear_of(const Corners& moved, std::size_t from, std::size_t to, std::uint64_t& cells) const;

 private:
  using Bits = RowRuns::Bits;
  void extend(const Corners& t, int depth);
  void ask(const Corners& t, double from, double to, int depth);
  bool is_asked(const Unrolled& u) const;
  void enter(const Corners& t, int depth);
  bool free(const Corners& t, double from, double to, int depth, std::uint64_t& cells) const;
  class BitsOfTurns;
  bool none_in(long row, const Bits& bits) const;
  Bits bits(double lo, double hi) const;
  Bits bits_of_bent(const Unrolled& u, double from, double to) const;
  /// False: a triangle of the mesh does not meet what the triangles asked sweep.
  bool near(const Unrolled& u) const { return near(u, 0, 0); }
  /// The same for a triangle that moves while the winding has turned from `from` to `to`, rad.
  bool near(const Unrolled& u, double from, double to) const {
    const double pitch = lead_ / kTurn;
    return u.r_hi >= ring_.r_lo && u.r_lo <= ring_.r_hi && u.z_hi + pitch * to + winding_.rounding >= ring_.z_lo &&
           u.z_lo + pitch * from - winding_.rounding <= ring_.z_hi;
  }

  static constexpr double kTurn = 2 * std::numbers::pi;
  const Winding& winding_;
  Ring ring_;
  double lead_;  // >= 0
  bool blind_;   // lead too small: nothing is proved
  UnrolledRaster fine_, wide_;
  double phi_lo_, phi_hi_;     // of the whole mesh; phi continues over turns, as psi is reduced to [0, lead)
  RowRuns asked_;              // by row and column of the wide raster: what the triangles asked sweep
  RowRuns taken_;              // by row and column
  bool empty_ = true;          // no triangle is near
  std::vector<Bits> by_bent_;  // by row: triangles near the axis, for all columns
};

}  // namespace dismantle::geometry
