/// Triangulates the surface of one solid or shell; faces share their vertices along edges.
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <cstdint>
#include <vector>

namespace dismantle::step_import {

struct FaceRange {
  TopoDS_Shape face;
  double area = 0;  ///< of its triangles
};

struct Surface {
  std::vector<std::array<double, 3>> vertices;  ///< in the frame of the shape without its location
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<FaceRange> faces;
  std::size_t missing_faces = 0;     ///< faces that could not be tessellated
  std::size_t mismatched_edges = 0;  ///< edges that their two faces divide differently: the surface is open there
};

/// `linear`: largest distance from a chord to its curve and from a triangle to its surface, in the shape's unit.
/// `angular`: largest turn of a curve or a surface normal from one vertex to the next, rad.
/// Triangles face outward if the shape is closed.
Surface tessellate(const TopoDS_Shape& shape, double linear, double angular);

}  // namespace dismantle::step_import
