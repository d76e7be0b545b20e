/// Where there is no room for a flat disc among facets, whichever way it is turned.
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

/// A disc with that radius, and all around it that is nearer than `half`, keep off the facets. Their frame.
class DiscRoom {
 public:
  DiscRoom(const Facets& facets, double radius, double half);

  /// Facets that are no further from the box than `reach`; of those given.
  std::vector<std::uint32_t> around(const Aabb& box, double reach, const std::vector<std::uint32_t>& of) const;

  /// Is all of the box nearer than `half` to a facet that is around it?
  bool near(const Aabb& box, const std::vector<std::uint32_t>& around);

  /// In the plane through a point across a normal: so much room the longest line has on both sides, of some directions.
  double longest(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, const std::vector<std::uint32_t>& around);

  /// Has no diameter room whose centre is in the box and whose direction is across the normal?
  bool shut(const Aabb& box, const Eigen::Vector3d& normal, const std::vector<std::uint32_t>& around);

  std::size_t work() const { return work_; }  ///< facets that were looked at

 private:
  struct Lines;
  struct Wall {
    Eigen::Vector2d a, b;
  };
  std::vector<Wall> walls(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                          const std::vector<std::uint32_t>& around);
  bool shut(const Aabb& box, const Lines& lines, const std::vector<std::uint32_t>& around, double share);
  bool meet(const FacetPlane& plane, const Aabb& box, const Lines& lines, double least, double most,
            std::vector<Eigen::Vector2d>& points) const;
  bool blocks(std::uint32_t plane, const Aabb& box, const Lines& lines);
  bool blocks(const std::vector<std::uint32_t>& planes, double side, const Aabb& box, const Lines& lines);

  const Facets& facets_;
  double radius_, near_;
  double free_ = 0;                      ///< the angle at which there was room last
  double steps_ = 0, shown_ = 0;         ///< of shut(): boxes and fans looked at, and the share of all that was shown
  std::vector<Eigen::Vector2d> points_;  ///< that room is made for only once
  std::size_t work_ = 0;
};

}  // namespace dismantle::immobility
