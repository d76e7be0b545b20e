/// Rule (c): the convex hulls of two groups of parts are disjoint.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// A part at its pose. The objects pointed to must outlive this one.
struct PlacedHull {
  const Mesh* mesh = nullptr;
  const Aabb* box = nullptr;                              ///< of the mesh
  const std::vector<Eigen::Vector3d>* corners = nullptr;  ///< of its convex hull
  Pose pose;
};

/// Answers queries that differ only in the shift. Not thread-safe.
class HullsApart {
 public:
  HullsApart(std::vector<PlacedHull> group, std::vector<PlacedHull> rest);
  /// True if the hulls are disjoint with the group moved by `shift`, proved on all vertices, or if a side is empty.
  bool after(const Eigen::Vector3d& shift);
  /// Distance along the unit vector `direction` after which the hulls are disjoint, by bisection. Returns at most
  /// `most`, where the hulls are assumed to be disjoint.
  double distance(const Eigen::Vector3d& direction, double most, int bisections);

 private:
  using Vec3 = Eigen::Vector3d;
  /// Boxes around parts, around runs of parts, around runs of these, and so on, so that finding the farthest point
  /// visits few parts.
  struct Side {
    std::vector<PlacedHull> parts;
    std::vector<Vec3> begin;                // of the parts: initial translations
    std::vector<std::vector<Aabb>> levels;  // first the boxes of the parts at their current poses; each next one: of
                                            // kRun of them

    explicit Side(std::vector<PlacedHull> placed);
    void move_to(const Vec3& shift);
    void set_boxes();
    template <class Bound, class Visit>
    void visit_farthest(std::size_t level, std::size_t first, const Bound& bound, const double& least,
                        const Visit& visit) const;
    Vec3 farthest(const Vec3& normal) const;
    double top(const Vec3& normal) const;
    double top_along(Eigen::Index axis, double sign) const;
    Aabb box() const;
  };
  static constexpr std::size_t kRun = 16;  // boxes under one box

  Side group_, rest_;
};

}  // namespace dismantle::geometry
