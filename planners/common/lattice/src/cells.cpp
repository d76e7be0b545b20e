#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "dismantle/lattice/lattice.h"

namespace dismantle::lattice {
namespace {

using Vec3 = Eigen::Vector3d;
using Polygon = std::vector<Vec3>;

// Lines through cells avoid the corners and diagonals of the grid, where the edges of its triangles are.
constexpr double kAside[2] = {0.0137, 0.0071};

/// The part of a convex polygon on one side of a plane across an axis.
Polygon clipped(const Polygon& polygon, int axis, double at, bool above) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = above ? a[axis] - at : at - a[axis], db = above ? b[axis] - at : at - b[axis];
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

using GridTriangle = std::array<Vec3, 3>;

std::vector<GridTriangle> in_grid(const Mesh& mesh, const Lattice& lattice) {
  std::vector<GridTriangle> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles.push_back({lattice.to_grid(mesh.vertex(t, 0)), lattice.to_grid(mesh.vertex(t, 1)),
                         lattice.to_grid(mesh.vertex(t, 2))});
  return triangles;
}

/// Cells whose box, with sides moved inwards, the surface meets.
std::set<Cell> met_cells(const std::vector<GridTriangle>& triangles, const Vec3& inset) {
  std::set<Cell> met;
  for (const GridTriangle& t : triangles) {
    const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    Cell first{}, last{};
    for (int k = 0; k < 3; ++k) {
      first[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(lo[k] + inset[k] - 1));
      last[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(hi[k] - inset[k]));
    }
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z) {
          if (met.contains({x, y, z})) continue;
          Polygon polygon(t.begin(), t.end());
          const Vec3 corner(x, y, z);
          for (int k = 0; k < 3 && !polygon.empty(); ++k) {
            polygon = clipped(polygon, k, corner[k] + inset[k], true);
            polygon = clipped(polygon, k, corner[k] + 1 - inset[k], false);
          }
          if (!polygon.empty()) met.insert({x, y, z});
        }
  }
  return met;
}

/// Cells whose middle, nearly, is inside: along the first axis, the surface is crossed an odd number of times.
std::set<Cell> inner_cells(const std::vector<GridTriangle>& triangles) {
  std::map<std::pair<int, int>, std::vector<double>> columns;
  for (const GridTriangle& t : triangles) {
    const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const Vec3 u = t[1] - t[0], v = t[2] - t[0];
    const double det = u.y() * v.z() - u.z() * v.y();
    if (std::abs(det) < 1e-12) continue;
    const auto first = [](double x, double aside) { return static_cast<int>(std::ceil(x - 0.5 - aside)); };
    for (int y = first(lo.y(), kAside[0]); y + 0.5 + kAside[0] <= hi.y(); ++y)
      for (int z = first(lo.z(), kAside[1]); z + 0.5 + kAside[1] <= hi.z(); ++z) {
        const double py = y + 0.5 + kAside[0] - t[0].y(), pz = z + 0.5 + kAside[1] - t[0].z();
        const double s = (py * v.z() - pz * v.y()) / det, r = (u.y() * pz - u.z() * py) / det;
        if (s >= 0 && r >= 0 && s + r <= 1) columns[{y, z}].push_back(t[0].x() + s * u.x() + r * v.x());
      }
  }
  std::set<Cell> inner;
  for (auto& [column, at] : columns) {
    std::sort(at.begin(), at.end());
    for (std::size_t k = 0; k + 1 < at.size(); k += 2)
      for (int x = static_cast<int>(std::ceil(at[k] - 0.5)); x + 0.5 < at[k + 1]; ++x)
        inner.insert({x, column.first, column.second});
  }
  return inner;
}

}  // namespace

std::vector<Cell> cells_of(const Mesh& mesh, const Lattice& lattice, const Vec3& inset, bool touched) {
  const auto triangles = in_grid(mesh, lattice);
  std::set<Cell> cells = inner_cells(triangles);
  if (touched) cells.merge(met_cells(triangles, inset));
  return {cells.begin(), cells.end()};
}

std::vector<Cell> full_cells_of(const Mesh& mesh, const Lattice& lattice, const Vec3& inset) {
  const auto triangles = in_grid(mesh, lattice);
  std::set<Cell> cells = inner_cells(triangles);
  for (const Cell& met : met_cells(triangles, inset)) cells.erase(met);
  return {cells.begin(), cells.end()};
}

}  // namespace dismantle::lattice
