/// The triangles that may be nearest to a point of a ball.
#pragma once

#include <cstdint>
#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// Triangles, each with a distance to keep from it. The clearance of a point is the least of (distance - kept distance)
/// over all triangles. Neither the clearance nor any of its terms changes faster than the point moves. So a term that
/// exceeds the least at the centre of a ball of radius r by more than 2 r is nowhere the least in the ball.
class NearestTriangles {
 public:
  using List = std::vector<std::uint32_t>;

  /// Adds the triangles of a body at a pose, each with the distance `keep`.
  void add(const Body& body, const Pose& pose, double keep);
  const List& all() const { return all_; }
  const Aabb& box() const { return box_; }
  /// The clearance over `list`. Fills `kept` with the triangles of it that may decide within `radius` of `p`.
  double clearance(const Vec3& p, const List& list, double radius, List& kept) const;
  /// The same for a single point, without `kept`.
  double clearance(const Vec3& p, const List& list) const;
  /// Triangles of `list` that may be within `reach` of the point; and of the plane through it with a unit normal.
  List around(const Vec3& p, double reach, const List& list) const;
  List around_plane(const Vec3& p, const Vec3& normal, double reach, const List& list) const;
  /// True if the triangle is certainly further than `reach` from the segment p +- half * line. `line` and `across` are
  /// orthogonal unit vectors.
  bool far_from_line(std::uint32_t t, const Vec3& p, const Vec3& line, const Vec3& across, double half,
                     double reach) const {
    const Corners& c = items_[t].corners;
    const Vec3 side(across.dot(c[0] - p), across.dot(c[1] - p), across.dot(c[2] - p));
    if (side.minCoeff() > reach || side.maxCoeff() < -reach) return true;
    const Vec3 along(line.dot(c[0] - p), line.dot(c[1] - p), line.dot(c[2] - p));
    return along.minCoeff() > half + reach || along.maxCoeff() < -half - reach;
  }
  const Corners& corners(std::uint32_t t) const { return items_[t].corners; }

 private:
  struct Item {
    Corners corners;
    double keep;
    Vec3 middle;
    double radius;  ///< of a ball about `middle` that contains the triangle
  };
  std::vector<Item> items_;
  List all_;
  Aabb box_;
};

}  // namespace dismantle::certificates
