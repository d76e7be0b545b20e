/// Which triangles are the nearest ones within a ball.
#pragma once

#include <cstdint>
#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// Triangles, each with a distance that is to be kept from it. The clearance of a point is the least of distance minus
/// that, over all of them. It changes no faster than the point moves: so do all its terms. Hence, of the terms at the
/// centre of a ball of radius r, those which exceed the least by more than 2 r are the least nowhere in the ball.
class NearestTriangles {
 public:
  using List = std::vector<std::uint32_t>;

  /// Those of a body at a pose.
  void add(const Body& body, const Pose& pose, double keep);
  const List& all() const { return all_; }
  const Aabb& box() const { return box_; }
  /// The clearance over `list`. Fills `kept` with those of it that may be the least within `radius` of `p`.
  double clearance(const Vec3& p, const List& list, double radius, List& kept) const;
  /// ... without the list: for single points.
  double clearance(const Vec3& p, const List& list) const;
  /// Of `list`, those that may be within `reach` of the point; and of the plane through it across a unit vector.
  List around(const Vec3& p, double reach, const List& list) const;
  List around_plane(const Vec3& p, const Vec3& normal, double reach, const List& list) const;
  /// Is the triangle certainly further than `reach` from a segment, `half` long on both sides of a point? `across`: a
  /// unit vector across the way.
  bool far_from_line(std::uint32_t t, const Vec3& p, const Vec3& way, const Vec3& across, double half,
                     double reach) const {
    const Corners& c = items_[t].corners;
    const Vec3 side(across.dot(c[0] - p), across.dot(c[1] - p), across.dot(c[2] - p));
    if (side.minCoeff() > reach || side.maxCoeff() < -reach) return true;
    const Vec3 along(way.dot(c[0] - p), way.dot(c[1] - p), way.dot(c[2] - p));
    return along.minCoeff() > half + reach || along.maxCoeff() < -half - reach;
  }
  const Corners& corners(std::uint32_t t) const { return items_[t].corners; }

 private:
  struct Item {
    Corners corners;
    double keep;
    Vec3 middle;
    double radius;  ///< of a ball about `middle` that holds it
  };
  std::vector<Item> items_;
  List all_;
  Aabb box_;
};

}  // namespace dismantle::certificates
