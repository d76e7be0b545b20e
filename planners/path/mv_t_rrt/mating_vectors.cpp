#include "mating_vectors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/search/placed_parts.h"

namespace dismantle::mv_t_rrt {
namespace {

using geometry::FaceAxis;

/// Sums areas by direction; opposite directions count as one. Merges only equal normals, as those of one flat face.
void add_faces(const Mesh& mesh, const Eigen::Quaterniond& q, std::vector<FaceAxis>& faces) {
  const double grid = std::sqrt(geometry::kRounding);  // unit vectors that round to the same multiples of it are equal
  std::map<std::tuple<long, long, long>, FaceAxis> by_direction;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d c = geometry::area_vector(mesh, t);
    if (!(c.norm() > 0)) continue;
    Eigen::Vector3d n = q * c.normalized();
    Eigen::Index largest = 0;
    n.cwiseAbs().maxCoeff(&largest);
    if (n[largest] < 0) n = -n;
    FaceAxis& face = by_direction[{std::lround(n.x() / grid), std::lround(n.y() / grid), std::lround(n.z() / grid)}];
    if (face.area == 0) face.axis = n;
    face.area += 0.5 * c.norm();
  }
  for (const auto& entry : by_direction) faces.push_back(entry.second);
}

}  // namespace

std::vector<Eigen::Vector3d> mating_vectors(const PathQuery& query, double reach, double merge_angle,
                                            std::size_t most) {
  std::vector<FaceAxis> faces;
  for (const auto& m : query.scene.moving) add_faces(*query.assembly.parts[m.part].mesh, m.pose.q, faces);
  Aabb near = path::box_of(query.assembly, query.scene.moving);
  near.inflate(reach);
  for (const auto& s : query.scene.fixed)
    if (path::box_of(query.assembly, {s}).overlaps(near))
      add_faces(*query.assembly.parts[s.part].mesh, s.pose.q, faces);
  geometry::sort_by_area(faces);

  // Merges normals into those with more area, then sorts by the sums.
  std::vector<FaceAxis> distinct;
  for (const FaceAxis& f : faces) geometry::add_face(distinct, f, std::cos(merge_angle));
  geometry::sort_by_area(distinct);
  std::vector<Eigen::Vector3d> directions;
  for (const auto& d : distinct)
    for (const double sign : {1.0, -1.0})
      if (directions.size() < most) directions.push_back(sign * d.axis);
  return directions;
}

}  // namespace dismantle::mv_t_rrt
