/// What contacts.cpp keeps of a part.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/statics/contacts.h"

namespace dismantle::statics {

/// An edge between faces that bend outward, or the start of it at a corner.
struct Ridge {
  Eigen::Vector3d from, to;
  Eigen::Vector3d left, right;  ///< outward normals of its two faces
};

/// A corner of the surface, and the edges that leave it.
struct Tip {
  Eigen::Vector3d at;
  std::vector<Eigen::Vector3d> directions;  ///< unit; to its neighbours
};

struct Shape::Data {
  explicit Data(const Mesh& m) : mesh(m), bvh(m) {}
  Mesh mesh;
  TriangleBvh bvh;
  double volume = 0, radius = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> normals;  ///< unit, of triangles; zero for those without area
  std::vector<Ridge> ridges;
  std::vector<Tip> tips;
};

}  // namespace dismantle::statics
