/// Positions among facets at which no diameter of a disc fits in a given plane.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "disc/facets.h"
#include "dismantle/aabb.h"

namespace dismantle::immobility {

inline Eigen::Vector3d corner(const Aabb& box, int k) {
  return {(k & 1 ? box.hi : box.lo).x(), (k & 2 ? box.hi : box.lo).y(), (k & 4 ? box.hi : box.lo).z()};
}

/// A disc of the given radius, thickened by `half`, must not meet the facets. In the frame of the facets.
class DiameterClearance {
 public:
  /// `slack`: as for the facets; reduces the disc.
  DiameterClearance(const Facets& facets, double radius, double half, double slack);

  /// The facets of `of` within `reach` of the box.
  std::vector<std::uint32_t> around(const Aabb& box, double reach, const std::vector<std::uint32_t>& of) const;

  /// True if every point of the box is nearer than `half` to a facet.
  bool all_near(const Aabb& box, const std::vector<std::uint32_t>& around);

  /// Samples lines through a point in the plane with a normal. Returns the largest length for which a line is free on
  /// both sides.
  double free_half_length(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                          const std::vector<std::uint32_t>& around);

  /// True if proved that no diameter fits with its centre in the box and its direction perpendicular to the normal.
  bool no_diameter_fits(const Aabb& box, const Eigen::Vector3d& normal, const std::vector<std::uint32_t>& around);

  std::size_t work() const { return work_; }  ///< number of tested facets

 private:
  struct Lines;
  struct Wall {
    Eigen::Vector2d a, b;
  };
  std::vector<Wall> walls(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                          const std::vector<std::uint32_t>& around);
  bool all_blocked(const Aabb& box, const Lines& lines, const std::vector<std::uint32_t>& around, double share);
  bool intersect(const FacetPlane& plane, const Aabb& box, const Lines& lines, double least, double most,
                 std::vector<Eigen::Vector2d>& points) const;
  bool blocks(std::uint32_t plane, const Aabb& box, const Lines& lines);
  bool blocks(const std::vector<std::uint32_t>& planes, double side, const Aabb& box, const Lines& lines);

  const Facets& facets_;
  double slack_, radius_, near_;
  double free_ = 0;                      ///< angle of the last free line
  double steps_ = 0, shown_ = 0;         ///< in no_diameter_fits(): subproblems so far, and share that is proved
  std::vector<Eigen::Vector2d> points_;  ///< buffer

  std::size_t work_ = 0;
};

}  // namespace dismantle::immobility
