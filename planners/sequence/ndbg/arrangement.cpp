#include "ndbg/arrangement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "blocking_graph/directions.h"

namespace dismantle::ndbg {
namespace {

using Eigen::Vector3d;

// Sine of the angle to a circle below which a direction lies on it. Cross products of normals from files are accurate
// to about 1e-7.
constexpr double kOnCircle = 1e-6;

using Signs = std::vector<int>;  // by circle: on which side, 0 on it

Signs signs_of(const std::vector<Vector3d>& normals, const Vector3d& d) {
  Signs signs;
  for (const Vector3d& n : normals) {
    const double side = n.dot(d);
    signs.push_back(std::abs(side) < kOnCircle ? 0 : side < 0 ? -1 : 1);
  }
  return signs;
}

/// Does a vertex lie on the closure of the cell?
bool bounds(const Signs& vertex, const Signs& cell) {
  for (std::size_t k = 0; k < cell.size(); ++k)
    if (vertex[k] != 0 && vertex[k] != cell[k]) return false;
  return true;
}

bool is_new(const std::vector<Vector3d>& known, const Vector3d& d) {
  // The cosine of an angle of 1.4e-5: vertices closer than that are on the same circles.
  return std::none_of(known.begin(), known.end(), [&](const Vector3d& v) { return v.dot(d) > 1 - 1e-10; });
}

std::size_t rank_of(const std::vector<Vector3d>& normals) {
  if (normals.empty()) return 0;
  Eigen::Matrix3Xd m(3, static_cast<Eigen::Index>(normals.size()));
  for (std::size_t k = 0; k < normals.size(); ++k) m.col(static_cast<Eigen::Index>(k)) = normals[k];
  Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(m);
  svd.setThreshold(1e-3);
  return static_cast<std::size_t>(svd.rank());
}

/// Cells around a vertex, as sign vectors: on the arcs that leave it, and in the sectors between these.
void cells_at(const Vector3d& vertex, const Signs& at, const std::vector<Vector3d>& normals, std::set<Signs>& arcs,
              std::set<Signs>& faces) {
  // Tangents of the circles through the vertex, in both directions, by angle.
  const Vector3d x = vertex.unitOrthogonal(), y = vertex.cross(x);
  std::vector<double> angles;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    if (at[k] != 0) continue;
    const Vector3d tangent = normals[k].cross(vertex);
    const double angle = std::atan2(tangent.dot(y), tangent.dot(x));
    angles.push_back(angle);
    angles.push_back(angle > 0 ? angle - std::numbers::pi : angle + std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  // The signs of a cell next to the vertex: those of the vertex, and on the circles through it those of the tangent.
  const auto next_to = [&](double angle) {
    const Vector3d tangent = std::cos(angle) * x + std::sin(angle) * y;
    Signs signs = at;
    for (std::size_t k = 0; k < normals.size(); ++k) {
      if (at[k] != 0) continue;
      const double side = normals[k].dot(tangent);
      signs[k] = std::abs(side) < kOnCircle ? 0 : side < 0 ? -1 : 1;
    }
    return signs;
  };
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const double next = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2 * std::numbers::pi;
    arcs.insert(next_to(angles[k]));
    faces.insert(next_to((angles[k] + next) / 2));
  }
}

}  // namespace

Arrangement arrangement_of(const std::vector<Vector3d>& normals) {
  Arrangement found;
  if (rank_of(normals) < 3) return found;
  for (std::size_t a = 0; a < normals.size(); ++a)
    for (std::size_t b = a + 1; b < normals.size(); ++b) {
      const Vector3d d = normals[a].cross(normals[b]).normalized();
      for (const Vector3d& v : {d, Vector3d(-d)})
        if (is_new(found.vertices, v)) found.vertices.push_back(v);
    }
  std::vector<Signs> at;
  std::set<Signs> arcs, faces;
  for (const Vector3d& v : found.vertices) {
    at.push_back(signs_of(normals, v));
    cells_at(v, at.back(), normals, arcs, faces);
  }
  const auto middle_of = [&](const Signs& cell) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = 0; k < at.size(); ++k)
      if (bounds(at[k], cell)) sum += found.vertices[k];
    return Vector3d(sum.normalized());
  };
  for (const Signs& arc : arcs) found.arcs.push_back(middle_of(arc));
  for (const Signs& face : faces) found.faces.push_back(middle_of(face));
  return found;
}

std::vector<Vector3d> circle_normals(const Assembly& assembly, std::size_t most) {
  const blocking::Directions suggested = blocking::directions_of(assembly);
  std::vector<Vector3d> normals;
  for (std::size_t k = 0; k < suggested.common.size() && normals.size() < most; k += 2)  // both signs are listed
    normals.push_back(suggested.all[suggested.common[k]]);
  for (int k = 0; k < 3 && rank_of(normals) < 3; ++k) {
    const std::size_t before = rank_of(normals);
    normals.push_back(Vector3d::Unit(k));
    if (rank_of(normals) == before) normals.pop_back();
  }
  return normals;
}

}  // namespace dismantle::ndbg
