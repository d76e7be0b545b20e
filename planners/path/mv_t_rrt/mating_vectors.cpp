#include "mating_vectors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dismantle/aabb.h"

namespace dismantle::mv_t_rrt {
namespace {

struct Face {
  Eigen::Vector3d normal;
  double area = 0;
};

Aabb world_box(const Assembly& assembly, const PlacedPart& part) {
  Aabb box;
  for (const auto& v : assembly.parts[part.part].mesh->vertices) box.extend(part.pose * v);
  return box;
}

/// Sums of area by direction, opposite directions together. Exactly equal normals first: a finely cut flat face is one.
void add_faces(const Mesh& mesh, const Eigen::Quaterniond& q, std::vector<Face>& faces) {
  constexpr double kGrid = 1e-6;
  std::map<std::tuple<long, long, long>, Face> by_direction;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d c = (mesh.vertex(t, 1) - mesh.vertex(t, 0)).cross(mesh.vertex(t, 2) - mesh.vertex(t, 0));
    if (!(c.norm() > 0)) continue;
    Eigen::Vector3d n = q * c.normalized();
    Eigen::Index largest = 0;
    n.cwiseAbs().maxCoeff(&largest);
    if (n[largest] < 0) n = -n;
    Face& face = by_direction[{std::lround(n.x() / kGrid), std::lround(n.y() / kGrid), std::lround(n.z() / kGrid)}];
    if (face.area == 0) face.normal = n;
    face.area += 0.5 * c.norm();
  }
  for (const auto& entry : by_direction) faces.push_back(entry.second);
}

}  // namespace

std::vector<Eigen::Vector3d> mating_vectors(const PathQuery& query, double reach, double merge_angle,
                                            std::size_t most) {
  std::vector<Face> faces;
  Aabb near;
  for (const auto& m : query.scene.moving) {
    near.extend(world_box(query.assembly, m));
    add_faces(*query.assembly.parts[m.part].mesh, m.pose.q, faces);
  }
  near.inflate(reach);
  for (const auto& s : query.scene.fixed)
    if (world_box(query.assembly, s).overlaps(near)) add_faces(*query.assembly.parts[s.part].mesh, s.pose.q, faces);
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.area > b.area; });

  // Merge into those of more area, then order by what they have together.
  std::vector<Face> distinct;
  const double same = std::cos(merge_angle);
  for (const auto& f : faces) {
    const auto known = std::find_if(distinct.begin(), distinct.end(),
                                    [&](const Face& d) { return std::abs(d.normal.dot(f.normal)) >= same; });
    if (known == distinct.end())
      distinct.push_back(f);
    else
      known->area += f.area;
  }
  std::stable_sort(distinct.begin(), distinct.end(), [](const Face& a, const Face& b) { return a.area > b.area; });
  std::vector<Eigen::Vector3d> directions;
  for (const auto& d : distinct)
    for (const double sign : {1.0, -1.0})
      if (directions.size() < most) directions.push_back(sign * d.normal);
  return directions;
}

}  // namespace dismantle::mv_t_rrt
