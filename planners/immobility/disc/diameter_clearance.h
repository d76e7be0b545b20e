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

/// A disc with that radius, thickened by `half`, must not meet the facets. In their frame.
class DiameterClearance {
 public:
  /// `slack`: as for the facets; the disc is taken to be smaller by that.
  DiameterClearance(const Facets& facets, double radius, double half, double slack);

  /// Of the given facets, those within `reach` of the box.
  std::vector<std::uint32_t> around(const Aabb& box, double reach, const std::vector<std::uint32_t>& of) const;

  /// Is every point of the box nearer than `half` to a facet?
  bool all_near(const Aabb& box, const std::vector<std::uint32_t>& around);

  /// In the plane through a point across a normal: how far the longest of some sampled lines through the point is free
  /// on both sides.
  double free_half_length(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                          const std::vector<std::uint32_t>& around);

  /// Proved that no diameter fits whose centre is in the box and whose direction is across the normal?
  bool no_diameter_fits(const Aabb& box, const Eigen::Vector3d& normal, const std::vector<std::uint32_t>& around);

  std::size_t work() const { return work_; }  ///< facets that were tested

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
  double free_ = 0;               ///< the angle at which a line was free last
  double steps_ = 0, shown_ = 0;  ///< of no_diameter_fits(): subproblems so far, and the share of all that was proved
  std::vector<Eigen::Vector2d> points_;  ///< buffer

  std::size_t work_ = 0;
};

}  // namespace dismantle::immobility
