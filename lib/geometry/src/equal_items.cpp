#include "dismantle/geometry/equal_items.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "dismantle/geometry/mass_properties.h"
#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::geometry {
namespace {

constexpr std::array<std::string_view, 9> kStandard{"screw", "nut",  "washer",  "spacer", "stand-off",
                                                    "pin",   "ring", "bearing", "insert"};
constexpr double kFacets = 0.02;  // relative difference of two tessellations of round parts: polygons of 16 corners
constexpr double kFlat = 1e-3;    // of the length between flat ends, which no tessellation changes

/// What stays the same when a part is displaced and cut into other triangles.
struct Measures {
  double volume = 0, area = 0, length = 0;  // `length`: along the axis
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  double hand = 0;  // of a thread: positive and negative for the two hands, 0 for what is its own mirror image
};

/// The principal axis whose moment differs most from the other two: that of a round part.
Eigen::Vector3d own_axis(const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& solver) {
  const Eigen::Vector3d m = solver.eigenvalues();
  return solver.eigenvectors().col(m[2] - m[1] > m[1] - m[0] ? 2 : 0).normalized();
}

Measures measures_of(const Mesh& mesh) {
  const MassProperties mass = mass_properties(mesh);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia);
  Measures out{.volume = mass.volume, .area = surface_area(mesh), .moments = solver.eigenvalues()};
  const Eigen::Vector3d axis = own_axis(solver);
  double low = 0, high = 0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const double z = axis.dot(v - mass.center);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  out.length = high - low;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a), around = axis.cross((a + b + c) / 3 - mass.center);
    const double lengths = normal.norm() * around.norm();  // twice the area, and the radius
    if (lengths > 0) out.hand += 0.5 * normal.dot(axis) * normal.dot(around) / lengths;
  }
  if (out.area > 0) out.hand /= out.area;
  return out;
}

bool same_item(const Measures& a, const Measures& b) {
  const auto near = [](double x, double y, double most) {
    return std::abs(x - y) <= most * std::max(std::abs(x), std::abs(y));
  };
  const double most_hand = 0.3 * std::max(std::abs(a.hand), std::abs(b.hand)) + 1e-4;  // facets are no thread
  for (int k = 0; k < 3; ++k)
    if (!near(a.moments[k], b.moments[k], 2 * kFacets)) return false;
  return near(a.volume, b.volume, kFacets) && near(a.area, b.area, kFacets) && near(a.length, b.length, kFlat) &&
         std::abs(a.hand - b.hand) <= most_hand;
}

}  // namespace

std::vector<std::size_t> equal_items(const std::vector<Part>& parts, const std::vector<ShapePlacement>& shapes,
                                     const std::vector<std::string>& kinds) {
  struct Known {
    std::size_t first;
    std::string kind;
    Measures measures;
  };
  std::vector<Known> known;
  std::vector<std::size_t> out(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out[i] = i;
    if (shapes[i].original != i) {
      out[i] = out[shapes[i].original];
      continue;
    }
    if (std::ranges::find(kStandard, kinds[i]) == kStandard.end()) continue;
    const Measures own = measures_of(*parts[i].mesh);
    if (own.volume <= 0) continue;
    const auto same =
        std::ranges::find_if(known, [&](const Known& k) { return k.kind == kinds[i] && same_item(k.measures, own); });
    if (same != known.end())
      out[i] = same->first;
    else
      known.push_back({i, kinds[i], own});
  }
  return out;
}

}  // namespace dismantle::geometry
