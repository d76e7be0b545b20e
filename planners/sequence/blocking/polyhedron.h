/// Exact distance that a polyhedron can be translated until it meets another, from faces and edges.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/mesh.h"

namespace dismantle::blocking {

/// A closed mesh as flat faces with straight edges between them. Adjacent coplanar triangles form one face. All
/// surfaces are moved inwards a little, so that parts which touch when assembled do not collide.
class Polyhedron {
 public:
  /// `inset`: distance by which surfaces are moved inwards, assembly units.
  Polyhedron(const Mesh& mesh, double inset);

  struct Edge {
    Eigen::Vector3d a, b;
  };
  struct Face {
    Eigen::Vector3d normal;
    double offset = 0;               ///< normal . x on the face
    std::vector<std::size_t> edges;  ///< indices of the boundary edges
  };

  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Face>& faces() const { return faces_; }
  const Aabb& box() const { return box_; }

 private:
  std::vector<Eigen::Vector3d> corners_;
  std::vector<Edge> edges_;
  std::vector<Face> faces_;
  Aabb box_;
};

/// Distance along unit vector `d` after which `a`, which starts translated by `offset`, meets `b`; infinite if it never
/// does. Passing within `tolerance` (less than the insets) counts as meeting. `a` and `b` must be apart at the start.
double distance_until_contact(const Polyhedron& a, const Polyhedron& b, const Eigen::Vector3d& offset,
                              const Eigen::Vector3d& d, double tolerance);

}  // namespace dismantle::blocking
