/// How far one polyhedron can be moved in a straight line until it meets another: exact, by its faces and edges.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/mesh.h"

namespace dismantle::blocking {

/// A closed mesh as flat faces with straight edges between them; triangles of one plane are one face. All surfaces are
/// moved inwards a little, so that parts which touch when assembled are apart: contact is not collision.
class Polyhedron {
 public:
  /// `inset`: how far inwards, assembly units.
  Polyhedron(const Mesh& mesh, double inset);

  struct Edge {
    Eigen::Vector3d a, b;
  };
  struct Face {
    Eigen::Vector3d normal;
    double offset = 0;               ///< normal . x on the face
    std::vector<std::size_t> edges;  ///< its boundary
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

/// Length of the way along unit vector `d` after which `a`, translated by `offset` at first, meets `b`; infinite when
/// it never does. `tolerance`, below the insets: what passes so close counts as meeting. The two are apart at first.
double distance_until_contact(const Polyhedron& a, const Polyhedron& b, const Eigen::Vector3d& offset,
                              const Eigen::Vector3d& d, double tolerance);

}  // namespace dismantle::blocking
