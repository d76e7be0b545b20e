/// Rule (c): when the convex hulls of two groups of parts are apart.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// A part at its pose. What is pointed to must outlive this.
struct PlacedHull {
  const Mesh* mesh = nullptr;
  const Aabb* box = nullptr;                              ///< of the mesh
  const std::vector<Eigen::Vector3d>* corners = nullptr;  ///< of its convex hull
  Pose pose;
};

/// For one question, or several of which only the shift differs. Not safe to call from several threads.
class HullsApart {
 public:
  HullsApart(std::vector<PlacedHull> group, std::vector<PlacedHull> rest);
  /// With all of the group moved by `shift`. True is certain on all vertices. True when there is nothing to be apart.
  bool after(const Eigen::Vector3d& shift);
  /// Distance along the unit vector `direction`, at most `most` (where it is taken for granted), by which the group has
  /// to be moved until it is so; by that number of bisections.
  double distance(const Eigen::Vector3d& direction, double most, int bisections);

 private:
  using Vec3 = Eigen::Vector3d;
  /// Boxes around the parts, and around runs of them, so that what reaches farthest is found at the cost of few parts.
  struct Side {
    std::vector<PlacedHull> parts;
    std::vector<Vec3> begin;   // of the parts: where they were put
    std::vector<Aabb> boxes;   // of the parts, where they are
    std::vector<Aabb> runs;    // of each kRun parts
    std::vector<double> most;  // of farthest(), by run: how far it could reach

    explicit Side(std::vector<PlacedHull> placed);
    void move_to(const Vec3& shift);
    void set_boxes();
    template <class Visit>
    void visit_farthest(const Vec3& normal, const double& least, const Visit& visit);
    Vec3 farthest(const Vec3& normal);
    double top(const Vec3& normal);
    double top_along(Eigen::Index axis, double sign) const;
    Aabb box() const;
  };
  static constexpr std::size_t kRun = 16;  // parts under one box: about the square root of the largest assemblies

  Side group_, rest_;
};

}  // namespace dismantle::geometry
