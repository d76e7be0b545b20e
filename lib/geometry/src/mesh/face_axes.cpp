#include "dismantle/geometry/face_axes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace dismantle::geometry {

void add_face(std::vector<FaceAxis>& axes, const FaceAxis& face, double same, std::size_t most) {
  const auto known = std::find_if(axes.begin(), axes.end(),
                                  [&](const FaceAxis& a) { return std::abs(a.axis.dot(face.axis)) >= same; });
  if (known != axes.end())
    known->area += face.area;
  else if (axes.size() < most)
    axes.push_back(face);
}

void sort_by_area(std::vector<FaceAxis>& axes, std::size_t most) {
  std::stable_sort(axes.begin(), axes.end(), [](const FaceAxis& a, const FaceAxis& b) { return a.area > b.area; });
  if (axes.size() > most) axes.resize(most);
}

std::vector<FaceAxis> rounded_axes(const std::vector<FaceAxis>& faces) {
  using Key = std::array<int, 3>;
  std::map<Key, FaceAxis> by_direction;
  for (FaceAxis face : faces) {
    Key key{};
    for (std::size_t k = 0; k < 3; ++k)
      key[k] = static_cast<int>(std::lround(1000 * face.axis[static_cast<Eigen::Index>(k)]));  // three decimals
    if (key < Key{}) {
      face.axis = -face.axis;
      for (int& k : key) k = -k;
    }
    by_direction.try_emplace(key, FaceAxis{face.axis, 0}).first->second.area += face.area;
  }
  std::vector<FaceAxis> axes;
  for (const auto& [key, axis] : by_direction) axes.push_back(axis);
  return axes;
}

std::vector<FaceAxis> largest_face_axes(const Mesh& mesh, std::size_t most) {
  std::vector<FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (const Eigen::Vector3d area = area_vector(mesh, t); area.norm() > 0)
      faces.push_back({area.normalized(), area.norm()});
  faces = rounded_axes(faces);
  sort_by_area(faces, most);
  return faces;
}

}  // namespace dismantle::geometry
