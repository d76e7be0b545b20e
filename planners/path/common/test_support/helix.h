/// A helical wire of round cross-section.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "dismantle/mesh.h"

namespace dismantle::path::test {

struct Helix {
  double radius = 0;  ///< of its middle line about the x axis; 0: a straight rod
  double pitch = 0, wire = 0, turns = 0;
  int around = 8, per_turn = 32;
};

/// From x = 0 to pitch * turns.
inline Mesh helix(const Helix& h) {
  Mesh mesh;
  const int steps = static_cast<int>(std::ceil(h.turns * h.per_turn));
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2 * M_PI * h.turns * i / steps;
    const Eigen::Vector3d out(0, std::cos(angle), std::sin(angle)), along(0, -out.z(), out.y());
    const Eigen::Vector3d forward = (h.radius * along + Eigen::Vector3d(h.pitch / (2 * M_PI), 0, 0)).normalized();
    const Eigen::Vector3d side = forward.cross(out);
    const Eigen::Vector3d middle = Eigen::Vector3d(h.pitch * angle / (2 * M_PI), 0, 0) + h.radius * out;
    for (int k = 0; k < h.around; ++k) {
      const double b = 2 * M_PI * k / h.around;
      mesh.vertices.emplace_back(middle + h.wire * (std::cos(b) * out + std::sin(b) * side));
    }
  }
  const auto n = static_cast<std::uint32_t>(h.around), last = static_cast<std::uint32_t>(steps) * n;
  for (std::uint32_t i = 0; i < last; i += n)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = i + k, b = i + (k + 1) % n;
      mesh.triangles.push_back({a, b, a + n});
      mesh.triangles.push_back({b, b + n, a + n});
    }
  for (std::uint32_t k = 1; k + 1 < n; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({last, last + k, last + k + 1});
  }
  return mesh;
}

}  // namespace dismantle::path::test
