/// Closed meshes with known measures for tests of geometry and verification.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"
#include "dismantle/assembly.h"
#include "dismantle/run_context.h"

namespace dismantle::shapes {

/// A point or direction.
using Vec3 = Eigen::Vector3d;

/// The surface of an axis-aligned box.
inline Mesh box(const Vec3& lo, const Vec3& hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// Appends the shells of `from`; `flip`: turned inside out.
inline void append(Mesh& to, const Mesh& from, bool flip = false) {
  const auto base = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const auto& t : from.triangles)
    to.triangles.push_back(flip ? Triangle{base + t[0], base + t[2], base + t[1]}
                                : Triangle{base + t[0], base + t[1], base + t[2]});
}

/// Both meshes in one.
inline Mesh joined(Mesh a, const Mesh& b) {
  append(a, b);
  return a;
}

/// The same surface, turned inside out: a void.
inline Mesh inside_out(Mesh m) {
  for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

/// One mesh with a closed shell for each box.
inline Mesh boxes(const std::vector<Aabb>& list) {
  Mesh m;
  for (const auto& b : list) append(m, box(b.lo, b.hi));
  return m;
}

/// Box with a closed cavity and walls of thickness `wall`.
inline Mesh closed_box(const Vec3& lo, const Vec3& hi, double wall) {
  Mesh m = box(lo, hi);
  append(m, box(lo + Vec3::Constant(wall), hi - Vec3::Constant(wall)), true);
  return m;
}

/// Divides each triangle into four, `times` times; vertices are shared.
inline Mesh refine(const Mesh& in, int times) {
  Mesh m = in;
  for (int k = 0; k < times; ++k) {
    std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> seen;
    Mesh next;
    next.vertices = m.vertices;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(a, b);
      for (const auto& [e, id] : seen)
        if (e == key) return id;
      next.vertices.push_back(0.5 * (m.vertices[a] + m.vertices[b]));
      seen.push_back({key, static_cast<std::uint32_t>(next.vertices.size() - 1)});
      return seen.back().second;
    };
    for (const auto& t : m.triangles) {
      const auto ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      next.triangles.insert(next.triangles.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    m = std::move(next);
  }
  return m;
}

/// Octahedron, refined and projected onto the sphere.
inline Mesh sphere(const Vec3& center, double radius, int times) {
  Mesh m;
  m.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  m.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  m = refine(m, times);
  for (auto& v : m.vertices) v = center + radius * v.normalized();
  return m;
}

/// Tube about z from z0 to z1 with the outline radii ro (outside) and ri (inside, 0 = solid).
inline Mesh tube(double ri, double ro, double z0, double z1, int around, int along = 1, double phase = 0) {
  Mesh m;
  const auto n = static_cast<std::uint32_t>(around), rows = static_cast<std::uint32_t>(along) + 1;
  const auto add_ring = [&](double r, double z) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = phase + 2 * std::numbers::pi * i / n;
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < rows; ++k) add_ring(ro, z0 + (z1 - z0) * k / along);
  for (std::uint32_t k = 0; k + 1 < rows; ++k)
    for (std::uint32_t i = 0; i < n; ++i)
      quad(k * n + i, k * n + (i + 1) % n, (k + 1) * n + (i + 1) % n, (k + 1) * n + i);
  const std::uint32_t top = (rows - 1) * n;
  if (ri <= 0) {
    const auto c0 = static_cast<std::uint32_t>(m.vertices.size());
    m.vertices.emplace_back(0, 0, z0);
    m.vertices.emplace_back(0, 0, z1);
    for (std::uint32_t i = 0; i < n; ++i) {
      m.triangles.push_back({c0, (i + 1) % n, i});
      m.triangles.push_back({c0 + 1, top + i, top + (i + 1) % n});
    }
    return m;
  }
  const auto in = static_cast<std::uint32_t>(m.vertices.size());
  for (std::uint32_t k = 0; k < rows; ++k) add_ring(ri, z0 + (z1 - z0) * k / along);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (std::uint32_t k = 0; k + 1 < rows; ++k)
      quad(in + k * n + j, in + k * n + i, in + (k + 1) * n + i, in + (k + 1) * n + j);
    quad(i, in + i, in + j, j);
    quad(top + i, top + j, in + top + j, in + top + i);
  }
  return m;
}

/// The mesh at a pose.
inline Mesh moved(Mesh m, const Pose& p) {
  for (auto& v : m.vertices) v = p * v;
  return m;
}

/// Volume that the surface encloses.
inline double volume(const Mesh& m) {
  double v = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    v += m.vertex(t, 0).dot(m.vertex(t, 1).cross(m.vertex(t, 2))) / 6;
  return v;
}

/// An assembly of these parts, without preparation.
inline Assembly assembly_of(const std::vector<Mesh>& meshes, std::vector<InitialOverlap> overlaps = {}) {
  Assembly a;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    Part p;
    p.id = static_cast<PartId>(i);
    p.name = "part" + std::to_string(i);
    p.file = p.name + ".obj";
    p.mesh = p.surface = std::make_shared<const Mesh>(meshes[i]);
    p.volume = volume(meshes[i]);
    a.input_box.extend(meshes[i].box());
    a.parts.push_back(p);
  }
  a.overlaps = std::move(overlaps);
  return a;
}

/// A displacement without rotation.
inline Pose shift(const Vec3& t) { return {t, Eigen::Quaterniond::Identity()}; }

/// Each coordinate uniform in [lo, hi).
inline Vec3 random_vector(Rng& rng, double lo, double hi) {
  return {rng.uniform(lo, hi), rng.uniform(lo, hi), rng.uniform(lo, hi)};
}

/// Random rotation; translation uniform in a cube of half edge `reach`.
inline Pose random_pose(Rng& rng, double reach) {
  Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  return {random_vector(rng, -reach, reach), q.normalized()};
}

}  // namespace dismantle::shapes
