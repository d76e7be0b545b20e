/// Where a plane cuts the surface of a solid: closed loops, and the pieces of surface between loops.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double offset = 0;
  double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

/// A closed curve on the surface, in a plane. A corner exactly in the plane counts as below it.
struct Loop {
  Plane plane;
  std::vector<Eigen::Vector3d> points;   ///< in order
  std::vector<std::uint32_t> triangles;  ///< triangles[k] is cut from points[k] to the next one

  /// Indices of the corners of the convex hull, in order around it. For collinear points: the two ends.
  std::vector<std::size_t> hull() const;
  /// The largest distance of two points.
  double diameter() const;
  /// True if the point, projected to the plane, is inside the curve.
  bool around(const Eigen::Vector3d& p) const;
};

/// The surface of a solid in the assembled frame, with the neighbours of each triangle.
class Surface {
 public:
  explicit Surface(const Solid& solid);

  std::vector<Loop> section(const Plane& plane) const;
  /// Offsets of planes across a direction, ascending: just above and below each corner and half way between corners,
  /// since sections change their shape only at corners. At most about `most`.
  std::vector<double> offsets(const Eigen::Vector3d& direction, std::size_t most) const;
  /// True if a path on the surface leads from one loop to the other. `above`: it starts on the side of the first loop's
  /// plane to which the normal points, else on the other side.
  bool connects(const Loop& from, const Loop& to, bool above) const;

  /// A closed surface: connected triangles, clipped where they cross some loops, and the flat discs inside these loops.
  class Closed {
   public:
    /// By the parity of crossings along rays; nullopt when the rays do not agree.
    std::optional<bool> inside(const Eigen::Vector3d& p) const;
    std::size_t discs() const { return discs_.size(); }
    const std::vector<const Loop*>& loops() const { return discs_; }

   private:
    friend class Surface;
    struct Piece {
      std::array<Eigen::Vector3d, 3> corners;
      std::vector<std::pair<Plane, double>> kept;  ///< clipping planes, and the sign of the side that is kept
    };
    std::vector<Piece> pieces_;
    std::vector<const Loop*> discs_;
    double rounding_ = 0;  ///< error of positions; assembly units
  };
  /// The piece of surface that is connected to loops[0] on the side of its plane where `p` lies, up to the loops,
  /// closed by their discs. Returns nullopt when it reaches the other side of a loop. `loops` must outlive it.
  std::optional<Closed> closed_by(const std::vector<Loop>& loops, const Eigen::Vector3d& p) const;

 private:
  double size_ = 0;  ///< diagonal of its box
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;  ///< [t][k]: across the edge from corner k to the next
};

}  // namespace dismantle::immobility
