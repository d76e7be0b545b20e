/// Closed test surfaces with known insides.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/mesh.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::sdf::test {

using shapes::box, shapes::inside_out, shapes::joined;

/// Ring of `around` x `across` quads: point(u, v) on a closed torus-like surface, u and v in [0, 1).
template <class F>
Mesh torus_like(int around, int across, const F& point) {
  Mesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j)
      m.vertices.push_back(point(static_cast<double>(i) / around, static_cast<double>(j) / across));
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      m.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      m.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return m;
}

inline Mesh torus(double big, double small, int around = 48, int across = 24) {
  return torus_like(around, across, [&](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
    const double r = big + small * std::cos(b);
    return Eigen::Vector3d(r * std::cos(a), r * std::sin(a), small * std::sin(b));
  });
}

/// A rod with a helical ridge, far thinner than a field cell: `turns` of a thread of depth `depth`.
inline Mesh threaded_rod(double radius, double depth, double length, int turns, int around = 24) {
  Mesh m;
  const int rows = turns * 8;
  for (int k = 0; k <= rows; ++k)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, z = length * k / rows;
      const double phase = std::fmod(turns * z / length + static_cast<double>(i) / around, 1.0);
      const double r = radius + depth * (1 - std::abs(2 * phase - 1));
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  const auto id = [&](int k, int i) { return static_cast<std::uint32_t>(k * around + i % around); };
  for (int k = 0; k < rows; ++k)
    for (int i = 0; i < around; ++i) {
      m.triangles.push_back({id(k, i), id(k, i + 1), id(k + 1, i + 1)});
      m.triangles.push_back({id(k, i), id(k + 1, i + 1), id(k + 1, i)});
    }
  const auto bottom = static_cast<std::uint32_t>(m.vertices.size()), top = bottom + 1;
  m.vertices.emplace_back(0, 0, 0);
  m.vertices.emplace_back(0, 0, length);
  for (int i = 0; i < around; ++i) {
    m.triangles.push_back({bottom, id(0, i + 1), id(0, i)});
    m.triangles.push_back({top, id(rows, i), id(rows, i + 1)});
  }
  return m;
}

/// Solid angle of the surface seen from p over 4 pi: the winding number, independent of the library.
inline double winding(const Mesh& m, const Eigen::Vector3d& p) {
  double total = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const Eigen::Vector3d a = m.vertex(t, 0) - p, b = m.vertex(t, 1) - p, c = m.vertex(t, 2) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    total += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return total / (4 * std::numbers::pi);
}

/// Distance by brute force: minimum over dense barycentric descent is not needed, triangles are convex.
inline double distance(const Mesh& m, const Eigen::Vector3d& p) {
  double best = 1e300;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const Eigen::Vector3d a = m.vertex(t, 0), b = m.vertex(t, 1), c = m.vertex(t, 2);
    const auto segment = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
      const double s = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
      return (p - (u + s * (v - u))).norm();
    };
    best = std::min({best, segment(a, b), segment(b, c), segment(c, a)});
    const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
    const Eigen::Vector3d q = p - n.dot(p - a) * n;
    const auto left = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return (v - u).cross(q - u).dot(n) >= 0; };
    if (left(a, b) && left(b, c) && left(c, a)) best = std::min(best, std::abs(n.dot(p - a)));
  }
  return best;
}

inline Eigen::Vector3d random_point(Rng& rng, const Aabb& box) {
  return {rng.uniform(box.lo.x(), box.hi.x()), rng.uniform(box.lo.y(), box.hi.y()), rng.uniform(box.lo.z(), box.hi.z())};
}

}  // namespace dismantle::sdf::test
