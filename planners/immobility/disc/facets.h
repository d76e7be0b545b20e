/// The surface of solids, divided into convex planar pieces.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "disc/outline.h"
#include "dismantle/aabb.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/pose.h"

namespace dismantle::immobility {

/// A convex planar piece of the surface.
struct Facet {
  std::uint32_t plane = 0;
  Outline outline;  ///< in that plane
  Aabb box, flat;   ///< box in space, and box of the outline

  bool within(const Eigen::Vector2d& p, double near) const {
    return p.x() >= flat.lo.x() - near && p.x() <= flat.hi.x() + near && p.y() >= flat.lo.y() - near &&
           p.y() <= flat.hi.y() + near && distance(outline, p) <= near;
  }
};

/// A plane that contains facets, with axes e and f in it.
struct FacetPlane {
  Eigen::Vector3d normal, e, f;  ///< unit
  double offset = 0, area = 0;
  std::vector<std::uint32_t> facets;

  double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
  Eigen::Vector2d flat(const Eigen::Vector3d& p) const { return {e.dot(p), f.dot(p)}; }
  Eigen::Vector3d point(const Eigen::Vector2d& p) const { return offset * normal + p.x() * e + p.y() * f; }
};

/// All the surface of some solids except degenerate triangles, in the frame of the largest solid.
class Facets {
 public:
  /// Triangles are merged when they are within a tenth of `slack` (> 0, assembly units) of one plane.
  Facets(const std::vector<Solid>& solids, double slack);

  const std::vector<Facet>& all() const { return facets_; }
  const Facet& operator[](std::uint32_t facet) const { return facets_[facet]; }
  const std::vector<FacetPlane>& planes() const { return planes_; }
  const FacetPlane& plane_of(std::uint32_t facet) const { return planes_[facets_[facet].plane]; }
  const Pose& frame() const { return frame_; }  ///< assembled = frame * local
  const Aabb& box() const { return box_; }
  /// Normals of faces with more than a `share` of the surface, the largest first.
  std::vector<Eigen::Vector3d> directions(std::size_t most, double share) const;

  /// True if every point of the convex hull of `points`, which are in the plane, is within `near` of the plane's
  /// facets.
  bool covers(std::uint32_t plane, const std::vector<Eigen::Vector2d>& points, double near) const;

  /// A plane, and whether its normal points away from the half space behind it (1) or into it (-1).
  struct Behind {
    std::uint32_t plane;
    double side;
  };
  /// As covers(), for the part of the hull that is behind the other planes.
  bool covers_behind(std::uint32_t plane, const std::vector<Eigen::Vector2d>& points, const std::vector<Behind>& others,
                     double near) const;

 private:
  struct Shell;
  void add(const Solid& solid);
  std::uint32_t plane_through(const Shell& shell, std::uint32_t triangle);
  void add_region(Shell& shell, std::uint32_t seed, std::uint32_t plane);
  bool covers(const FacetPlane& plane, const Outline& piece, double near, int& left) const;

  double slack_;
  Pose frame_;
  Aabb box_;
  std::vector<Facet> facets_;
  std::vector<FacetPlane> planes_;
  std::multimap<double, std::uint32_t> by_offset_;  ///< planes, to find equal ones
};

}  // namespace dismantle::immobility
