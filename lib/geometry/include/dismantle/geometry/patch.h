/// A (piece of a) triangle and the translations that move it out of another solid.
///
/// The displacement rule: move the corners of a triangle by at most e each, and the other points linearly with them. If
/// the moved triangle lies outside solid B without crossing its surface, no point of the triangle is deeper than e in
/// B, because the displacement of the point leads out through the surface of B.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/sweep.h"

namespace dismantle::geometry {

/// One triangle of a part, as the sweep tests see it.
struct Patch {
  Corners p;       ///< frame of its part
  Corners inward;  ///< displacement of the vertex rule for a unit of depth, lengths <= 1
  std::uint32_t triangle = 0;
  std::uint32_t halved = 0;  ///< times in a row

  Eigen::Vector3d center() const { return (p[0] + p[1] + p[2]) / 3; }
  double longest_edge() const;
  double radius() const;  ///< largest distance of a corner from the centre
  std::array<Patch, 4> quarters() const;
  /// Two pieces, divided by the line from the opposite corner to the point at `t` on edge `edge` (0: p[0] to p[1],
  /// ...).
  std::array<Patch, 2> halves(std::size_t edge, double t) const;
};

/// Corners moved by `depth` times the patch's own inward directions: the vertex rule. Neighbours stay joined.
Corners moved_by_vertices(const Patch& patch, double depth);
/// Corners moved in one direction (unit), for instance the inward normal of the face, and a little across it by the
/// vertex rule, since faces that adjoin the edge may touch something.
Corners moved_along(const Patch& patch, const Eigen::Vector3d& direction, double depth);

/// Depths of the corners of a patch in a solid.
struct Probe {
  std::array<double, 3> depth;  ///< > 0 inside, < 0 outside; distance to the surface
  Corners out;                  ///< unit, frame of the patch's part: the shortest way out
  int deepest = 0;

  /// Takes over every corner that is deeper in `other`.
  void deepen(const Probe& other);
};
/// Depths of the corners of a placed patch in another solid.
Probe probe(const Patch& patch, const Placement& place, const Solid& other);
/// Corners moved along the shortest way out and beyond the surface by half of the rest of `depth`, and across that by
/// the vertex rule; none by more than `depth`.
Corners moved_by_probe(const Patch& patch, const Probe& probe, double depth);

/// Depth of a point in a solid, in the frame of the solid.
struct Escape {
  double depth;         ///< > 0 inside, < 0 outside; distance to the surface
  Eigen::Vector3d out;  ///< unit: the shortest way out
};
/// Depth of `point` in `solid`.
Escape escape_at(const Eigen::Vector3d& point, const Solid& solid);

/// An edge of the patch whose ends have different shortest ways out, and the point on it where both are equally long.
/// The depth has a ridge there, and pieces on either side of it are easier to certify. None after two halvings in a
/// row: where ridges meet, cutting along one of them would not end.
struct Ridge {
  std::size_t edge;
  double t;
};
/// The ridge that crosses the patch, if there is one.
std::optional<Ridge> ridge_on(const Patch& patch, const Probe& probe);

/// The corners at a placement.
Corners placed(const Placement& place, const Corners& p);

}  // namespace dismantle::geometry
