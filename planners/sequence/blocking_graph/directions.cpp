#include "blocking_graph/directions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "dismantle/geometry/face_axes.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;
using geometry::FaceAxis;

// Axes within 0.08 degrees (cosine) are the same axis. A straight path that deviates more rubs at a long fit.
constexpr double kSame = 1 - 1e-6;

/// The same axis with the sign that makes the first nonzero coefficient (up to rounding) positive.
Vec3 with_sign(const Vec3& v) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1e-9) return v[k] < 0 ? Vec3(-v) : v;
  return v;
}

std::vector<FaceAxis> weighted_axes(const Mesh& mesh, std::size_t most) {
  // Normals are binned first, since round surfaces have thousands.
  std::map<std::array<long, 3>, FaceAxis> bins;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 cross = geometry::area_vector(mesh, t);
    const double area = 0.5 * cross.norm();
    if (!(area > 0)) continue;
    const Vec3 n = with_sign(cross.normalized());
    total += area;
    spread += area * n * n.transpose();
    auto& bin = bins[{std::lround(n.x() * 2000), std::lround(n.y() * 2000), std::lround(n.z() * 2000)}];
    bin.axis += area * n;
    bin.area += area;
  }
  std::vector<FaceAxis> sorted;
  for (auto& [key, bin] : bins) sorted.push_back({bin.axis.normalized(), bin.area});
  geometry::sort_by_area(sorted, 64);
  std::vector<FaceAxis> axes;
  for (const auto& w : sorted) geometry::add_face(axes, w, kSame);
  geometry::sort_by_area(axes);
  std::erase_if(axes, [&](const FaceAxis& w) { return w.area < 0.02 * total; });  // chamfers, facets of fillets
  if (axes.size() > most) axes.resize(most);
  if (total > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    geometry::add_face(axes, {with_sign(solver.eigenvectors().col(0)), 0.01 * total}, kSame);
  }
  return axes;
}

}  // namespace

std::vector<Vec3> axes_of(const Mesh& mesh, std::size_t most) {
  std::vector<Vec3> axes;
  for (const auto& w : weighted_axes(mesh, most)) axes.push_back(w.axis);
  return axes;
}

Directions directions_of(const Assembly& assembly) {
  std::vector<FaceAxis> all;  // in the order of their first appearance, so that indices stay valid
  for (int k = 0; k < 3; ++k) all.push_back({Vec3::Unit(k), 0});
  std::vector<std::vector<std::size_t>> own(assembly.parts.size());
  std::map<const Mesh*, std::vector<FaceAxis>> known;  // copies of a part may share their mesh
  for (const auto& part : assembly.parts) {
    auto [entry, is_new] = known.try_emplace(part.mesh.get());
    if (is_new) entry->second = weighted_axes(*part.mesh, 5);  // a box has three; two more for inclined faces
    for (const auto& w : entry->second) {
      geometry::add_face(all, w, kSame);
      for (std::size_t k = 0; k < all.size(); ++k)
        if (std::abs(all[k].axis.dot(w.axis)) > kSame) own[part.id].push_back(k);
    }
  }
  std::vector<std::size_t> by_area(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) by_area[k] = k;
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](std::size_t a, std::size_t b) { return all[a].area > all[b].area; });
  if (by_area.size() > 6) by_area.resize(6);  // each is tried for every part

  Directions result;
  for (const auto& w : all) {
    result.all.push_back(w.axis);
    result.all.push_back(-w.axis);
  }
  const auto both = [](std::vector<std::size_t>& list, std::size_t axis) {
    list.push_back(2 * axis);
    list.push_back(2 * axis + 1);
  };
  for (const std::size_t axis : by_area) both(result.common, axis);
  for (auto& axes : own) {
    for (std::size_t k = 0; k < 3; ++k) axes.push_back(k);
    axes.insert(axes.end(), by_area.begin(), by_area.end());
    std::sort(axes.begin(), axes.end());
    axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
    result.of_part.emplace_back();
    for (const std::size_t axis : axes) both(result.of_part.back(), axis);
  }
  return result;
}

}  // namespace dismantle::blocking
