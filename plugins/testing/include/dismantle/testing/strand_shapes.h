/// Wires, coils and loops in various triangulations.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::shapes {

/// Corners of a section, counter-clockwise, relative to the line that it is swept along.
using Outline = std::vector<Eigen::Vector2d>;

/// A regular polygon whose corners are at `radius`.
inline Outline polygon(double radius, int sides, double phase = 0) {
  Outline out;
  for (int k = 0; k < sides; ++k) {
    const double a = phase + 2 * std::numbers::pi * k / sides;
    out.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return out;
}

/// A section swept along a line without twist. `closed`: a planar line whose last point is connected to the first.
inline Mesh sweep(const std::vector<Vec3>& line, const Outline& section, bool closed) {
  Mesh m;
  const std::size_t n = line.size(), s = section.size();
  const auto direction = [&](std::size_t k) {
    const Vec3& before = line[k > 0 ? k - 1 : closed ? n - 1 : 0];
    const Vec3& after = line[k + 1 < n ? k + 1 : closed ? 0 : n - 1];
    return Vec3((line[k] - before).stableNormalized() + (after - line[k]).stableNormalized()).normalized().eval();
  };
  Vec3 t = direction(0), u = t.unitOrthogonal();
  if (closed) u = (line[n / 3] - line[0]).cross(line[2 * n / 3] - line[0]).normalized();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 next = direction(k);
    u = Eigen::Quaterniond::FromTwoVectors(t, next) * u;
    t = next;
    const Vec3 v = t.cross(u);
    for (const auto& p : section) m.vertices.push_back(line[k] + p.x() * u + p.y() * v);
  }
  const auto at = [&](std::size_t k, std::size_t i) { return static_cast<std::uint32_t>(k % n * s + i % s); };
  for (std::size_t k = 0; k + (closed ? 0 : 1) < n; ++k)
    for (std::size_t i = 0; i < s; ++i) {
      m.triangles.push_back({at(k, i), at(k, i + 1), at(k + 1, i + 1)});
      m.triangles.push_back({at(k, i), at(k + 1, i + 1), at(k + 1, i)});
    }
  if (closed) return m;
  for (std::size_t i = 1; i + 1 < s; ++i) {
    m.triangles.push_back({at(0, 0), at(0, i + 1), at(0, i)});
    m.triangles.push_back({at(n - 1, 0), at(n - 1, i), at(n - 1, i + 1)});
  }
  return m;
}

/// The same surface with other triangles: splits some edges at random points, `rounds` times.
inline Mesh retriangulated(Mesh m, Rng& rng, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> of;  // directed edge -> triangle
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) of[{m.triangles[t][k], m.triangles[t][(k + 1) % 3]}] = t;
    std::vector<char> cut(m.triangles.size(), 0);
    const std::size_t count = m.triangles.size();
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::size_t k = rng.below(3);
      const std::uint32_t a = m.triangles[t][k], b = m.triangles[t][(k + 1) % 3];
      const auto back = of.find({b, a});
      if (cut[t] || back == of.end() || cut[back->second] || rng.below(2) == 0) continue;
      const auto middle = static_cast<std::uint32_t>(m.vertices.size());
      const double share = rng.uniform(0.2, 0.8);
      m.vertices.push_back((1 - share) * m.vertices[a] + share * m.vertices[b]);
      for (const auto& [triangle, from, to] : {std::tuple(t, a, b), std::tuple(back->second, b, a)}) {
        Triangle one = m.triangles[triangle], two = one;
        std::replace(one.begin(), one.end(), to, middle);
        std::replace(two.begin(), two.end(), from, middle);
        m.triangles[triangle] = one;
        m.triangles.push_back(two);
        cut[triangle] = 1;
      }
    }
  }
  return m;
}

/// The mesh with a random rotation, translation and scale (up to a factor of 1000 either way).
inline Mesh anywhere(Mesh m, Rng& rng) {
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.1, 1)).normalized();
  const double scale = std::pow(10, rng.uniform(-3, 3));
  const Vec3 shift(rng.uniform(-20, 20), rng.uniform(-20, 20), rng.uniform(-20, 20));
  for (Vec3& v : m.vertices) v = scale * (q * v + shift);
  return m;
}

/// The line of a coil about z, `per_turn` points to a turn; the radius changes from `radius` to `last`.
inline std::vector<Vec3> coil_line(double radius, double last, double pitch, double turns, int per_turn) {
  std::vector<Vec3> line;
  const int pieces = static_cast<int>(std::ceil(turns * per_turn));
  for (int k = 0; k <= pieces; ++k) {
    const double u = static_cast<double>(k) / pieces, a = 2 * std::numbers::pi * turns * u;
    const double r = radius + (last - radius) * u;
    line.emplace_back(r * std::cos(a), r * std::sin(a), pitch * turns * u);
  }
  return line;
}

/// The closed line around two pulleys, without repeating the first point. Equal radii and distance 0 give a circle.
inline std::vector<Vec3> belt_line(double r, double other, double distance, int per_turn) {
  std::vector<Vec3> line;
  const double lean = distance > 0 ? std::asin((r - other) / distance) : 0, pi = std::numbers::pi;
  const auto arc = [&](double x, double radius, double from, double to) {
    const int pieces = std::max(3, static_cast<int>(std::ceil((to - from) / (2 * pi) * per_turn)));
    for (int k = 0; k < pieces + (distance > 0 ? 1 : 0); ++k) {
      const double a = from + (to - from) * k / pieces;
      line.emplace_back(x + radius * std::cos(a), radius * std::sin(a), 0);
    }
  };
  if (distance <= 0) {
    arc(0, r, 0, 2 * pi);
    return line;
  }
  arc(0, r, pi / 2 - lean, 3 * pi / 2 + lean);
  arc(distance, other, -pi / 2 + lean, pi / 2 - lean);
  return line;
}

}  // namespace dismantle::shapes
