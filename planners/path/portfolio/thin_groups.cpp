#include "thin_groups.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::portfolio {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kBalls = 24;  // of all moving parts together

/// The lower quartile, so that one thin end does not determine it.
double typical_radius(const PathQuery& query) {
  std::vector<double> radii;
  const std::size_t each = std::max<std::size_t>(4, kBalls / query.scene.moving.size());
  for (const auto& m : query.scene.moving) {
    const std::vector<double> own = inner_radii(*query.assembly.parts[m.part].mesh, each);
    radii.insert(radii.end(), own.begin(), own.end());
  }
  if (radii.empty()) return 0;
  const auto quartile = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 4);
  std::nth_element(radii.begin(), quartile, radii.end());
  return *quartile;
}

}  // namespace

std::vector<double> inner_radii(const Mesh& mesh, std::size_t max_count) {
  std::vector<double> radii;
  std::vector<Vec3> surface, inward;
  // About 1000 triangles are enough to choose from, so a finer mesh does not cost more.
  const std::size_t stride = mesh.triangles.size() / 1000 + 1;
  for (std::size_t k = 0; k < mesh.triangles.size(); k += stride) {
    const Triangle& t = mesh.triangles[k];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0)) continue;
    // A large triangle reaches far, so each one has three samples, each near one of its corners.
    for (const Vec3& p : {a, b, c}) {
      surface.emplace_back((4 * p + (a + b + c)) / 7);
      inward.push_back(-n.normalized());
    }
  }
  if (surface.empty()) return radii;
  const TriangleBvh bvh(mesh);
  const double size = mesh.box().size().norm();
  std::vector<double> distance_to_chosen(surface.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t k = 0; k < surface.size(); ++k)
    if ((surface[k] - mesh.box().center()).norm() > (surface[next] - mesh.box().center()).norm()) next = k;
  while (radii.size() < max_count && distance_to_chosen[next] > 1e-9) {  // samples that coincide are chosen once
    radii.push_back(inner_ball_radius(bvh, surface[next], inward[next], size));
    const Vec3 chosen = surface[next];
    for (std::size_t k = 0; k < surface.size(); ++k)
      distance_to_chosen[k] = std::min(distance_to_chosen[k], (surface[k] - chosen).norm());
    next = static_cast<std::size_t>(std::max_element(distance_to_chosen.begin(), distance_to_chosen.end()) -
                                    distance_to_chosen.begin());
  }
  return radii;
}

bool thinner_than_overlap(const PathQuery& query) {
  double overlap = 0;
  for (const auto& m : query.scene.moving)
    for (const auto& s : query.scene.fixed) overlap = std::max(overlap, query.assembly.initial_overlap(m.part, s.part));
  // Half a radius is a quarter of the thickness, the penetration that the verifier tolerates in a thin wall.
  return overlap > 0 && overlap > 0.5 * typical_radius(query);
}

}  // namespace dismantle::portfolio
