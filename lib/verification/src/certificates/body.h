/// Parts as the checkers of certificates see them: closed surfaces of triangles, measured by plain formulas.
///
/// Nothing here is shared with the provers (planners/immobility): no hierarchies, no grids, no rays. Triangles are gone
/// through one by one; where there are many questions, lists of them are shortened by distances (NearestTriangles).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/immobility_prover.h"

namespace dismantle::certificates {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Corners = std::array<Vec3, 3>;

/// One solid of a part, as the law of a valid motion has it: an outer shell with its voids. Assembled frame.
struct Body {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
  bool closed = false;              ///< each directed edge has its opposite
  Aabb box;
  Eigen::Quaterniond frame = Eigen::Quaterniond::Identity();  ///< along its largest faces

  Corners corners(std::size_t t) const {
    return {vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]};
  }
};

/// Computed once in an assembly.
const std::vector<Body>& bodies_of(const SeparationQuery& query, PartId part);

/// A length that errors of rounding stay below, with a large margin: of positions within the box, or within that of the
/// part.
double rounding_of(const Aabb& box);
double rounding_of(const SeparationQuery& query, PartId part);

/// The depth up to which valid motions may let two parts penetrate each other.
double allowed_depth(const SeparationQuery& query, PartId a, PartId b);

/// To a point of the triangle that is the nearest one but for rounding: never less than the distance.
double distance(const Vec3& p, const Corners& triangle);
double distance(const Vec3& p, const Body& body);

/// Of the triangle seen from the point, with a sign: sums over a closed surface are multiples of 4 pi (Van Oosterom and
/// Strackee 1983).
double solid_angle(const Vec3& p, const Corners& triangle);

/// Is the winding number of the surface about the point one or more? False where the sum of the solid angles is no
/// multiple of 4 pi.
bool inside(const Vec3& p, const Body& body);

/// Distance from the surface if the point is inside, else 0.
double depth(const Vec3& p, const Body& body);

/// Why a point of one part might get into a body of another; nullptr if it never does in valid motions: assembled it is
/// outside, and in its own part deeper than the surface of the other may get, which would have to pass it.
const char* objection_to_outside_point(const SeparationQuery& query, PartId own, PartId other, const Body& obstacle,
                                       const Vec3& point);

}  // namespace dismantle::certificates
