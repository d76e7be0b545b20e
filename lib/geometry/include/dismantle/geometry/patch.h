/// A triangle, or a piece of one, and the displacements that move it out of another solid.
///
/// All of them use the displacement rule: move each corner of a triangle by at most e, and all other points linearly
/// between the corners. If the moved triangle lies outside solid B without crossing its surface, no point of the
/// triangle is deeper than e in B, because the displacement of the point crosses the surface of B.
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
  Corners inward;  ///< displacement by the vertex rule per unit of depth, lengths <= 1
  std::uint32_t triangle = 0;
  std::uint32_t halved = 0;  ///< consecutive halvings

  Eigen::Vector3d center() const { return (p[0] + p[1] + p[2]) / 3; }
  double longest_edge() const;
  double radius() const;  ///< largest distance of a corner from the centre
  std::array<Patch, 4> quarters() const;
  /// Two pieces, divided by the line from the opposite corner to the point `t` on edge `edge` (0: p[0] to p[1], ...).
  std::array<Patch, 2> halves(std::size_t edge, double t) const;
};

/// Vertex rule: corners moved by `depth` times the inward vectors of the patch. Neighbours stay connected.
Corners moved_by_vertices(const Patch& patch, double depth);
/// Corners moved along the unit `direction`, for example the inward face normal, and slightly across it by the vertex
/// rule, since faces that adjoin an edge may touch something.
Corners moved_along(const Patch& patch, const Eigen::Vector3d& direction, double depth);

/// Positions of the corners of a patch relative to a solid.
struct Probe {
  std::array<double, 3> depth;  ///< > 0 inside, < 0 outside; distance to the surface
  Corners out;                  ///< unit, frame of the patch's part: the shortest way out
  int deepest = 0;

  /// Copies every corner that is deeper in `other`.
  void deepen(const Probe& other);
};
/// Probes a placed patch against another solid.
Probe probe(const Patch& patch, const Placement& place, const Solid& other);
/// Corners moved the shortest way out, then beyond the surface by half of the remaining `depth`, and across that by the
/// vertex rule; none moves by more than `depth`.
Corners moved_by_probe(const Patch& patch, const Probe& probe, double depth);

/// Position of a point relative to a solid, in the frame of the solid.
struct Escape {
  double depth;         ///< > 0 inside, < 0 outside; distance to the surface
  Eigen::Vector3d out;  ///< unit: the shortest way out
};
/// Position of `point` relative to `solid`.
Escape escape_at(const Eigen::Vector3d& point, const Solid& solid);

/// An edge of the patch whose ends have different ways out, and the point on it where both ways are equally long. The
/// depth has a ridge there, and the pieces on its two sides are easier to verify.
struct Ridge {
  std::size_t edge;
  double t;
};
/// The ridge to cut at, if any. None after two consecutive halvings: where ridges meet, cutting would never end.
std::optional<Ridge> ridge_on(const Patch& patch, const Probe& probe);

/// The corners at a placement.
Corners placed(const Placement& place, const Corners& p);

}  // namespace dismantle::geometry
