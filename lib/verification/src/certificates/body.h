/// Parts for the checkers of certificates: closed surfaces of triangles, measured by plain formulas.
///
/// Shares no code with the provers (planners/immobility): no hierarchies, no grids, no rays. Queries go through the
/// triangles one by one; for many queries, distances shorten the lists of triangles (NearestTriangles).
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

/// One solid of a part, as in the law of a valid motion: an outer shell with its voids. Assembled frame.
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

/// Computed once per assembly.
const std::vector<Body>& bodies_of(const SeparationQuery& query, PartId part);

/// Upper bound of rounding errors of positions within the box, or within the part's box, with a large margin.
double rounding_of(const Aabb& box);
double rounding_of(const SeparationQuery& query, PartId part);

/// The depth up to which valid motions may let two parts penetrate each other.
double allowed_depth(const SeparationQuery& query, PartId a, PartId b);

/// Distance to the nearest point of the triangle, as computed with rounding: never less than the exact distance.
double distance(const Vec3& p, const Corners& triangle);
double distance(const Vec3& p, const Body& body);

/// Signed solid angle of the triangle seen from the point. Sums over a closed surface are multiples of 4 pi (Van
/// Oosterom and Strackee 1983).
double solid_angle(const Vec3& p, const Corners& triangle);

/// True if the winding number of the surface about the point is at least 1. False where the sum of the solid angles is
/// not a multiple of 4 pi.
bool inside(const Vec3& p, const Body& body);

/// Distance from the surface if the point is inside, else 0.
double depth(const Vec3& p, const Body& body);

/// Checks that a point of one part never enters a body of another in valid motions: it is outside when assembled, and
/// deeper in its own part than the other's surface may get, which would have to pass it. Returns nullptr if so, else
/// the reason.
const char* objection_to_outside_point(const SeparationQuery& query, PartId own, PartId other, const Body& obstacle,
                                       const Vec3& point);

}  // namespace dismantle::certificates
