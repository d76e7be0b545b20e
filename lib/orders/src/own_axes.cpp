#include "own_axes.h"

#include "dismantle/geometry/face_axes.h"

namespace dismantle {

namespace {
constexpr std::size_t kOwnAxes = 3;     // of the faces of a part, beside the coordinate axes
constexpr double kSameAxis = 1 - 1e-6;  // cosine: a straight path that deviates more rubs at a long fit
}  // namespace

std::vector<Eigen::Vector3d> own_axes(const std::vector<PartId>& parts, const Assembly& assembly) {
  std::vector<geometry::FaceAxis> axes;
  for (int k = 0; k < 3; ++k) axes.push_back({Eigen::Vector3d::Unit(k), 0});
  if (parts.size() == 1)
    for (const geometry::FaceAxis& face : geometry::largest_face_axes(*assembly.parts[parts.front()].mesh, kOwnAxes))
      geometry::add_face(axes, face, kSameAxis);
  std::vector<Eigen::Vector3d> out;
  for (const geometry::FaceAxis& axis : axes) out.push_back(axis.axis);
  return out;
}

}  // namespace dismantle
