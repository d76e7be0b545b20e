// Turned solids with outlines of any shape: screws, nuts, washers.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/mesh.h"

namespace dismantle::fasteners::test {

/// Radius by angle.
using Outline2 = std::function<double(double)>;

inline Outline2 circle(double diameter) {
  return [=](double) { return diameter / 2; };
}
/// A regular polygon of this width across flats.
inline Outline2 polygon(int sides, double flats) {
  return [=](double angle) {
    const double turn = 2 * std::numbers::pi / sides;
    return flats / 2 / std::cos(std::remainder(angle, turn));
  };
}
/// A cross of four arms.
inline Outline2 cross(double span, double arm) {
  return [=](double angle) {
    const double a = std::abs(std::remainder(angle, std::numbers::pi / 2));
    return std::min(span / 2, arm / 2 / std::max(std::sin(a), 1e-6));
  };
}
/// Six lobes.
inline Outline2 torx(double points) {
  return [=](double angle) { return points / 2 * (0.86 + 0.14 * std::cos(6 * angle)); };
}
/// A right-hand thread: a groove that runs up.
struct ThreadOn {
  double major, pitch;
  double at(double angle, double z) const {
    const double phase = z / pitch - angle / (2 * std::numbers::pi), f = std::abs(2 * (phase - std::floor(phase)) - 1);
    return major / 2 - 0.6134 * pitch * f;
  }
};

/// A ring of points round the axis.
struct Ring {
  double z;
  Outline2 radius;
};

/// The surface through rings, one after the other, closed from the last to the first: rings of radius 0 are points on
/// the axis. Outside first, upwards; then the inside, downwards.
inline Mesh turned_solid(const std::vector<Ring>& rings, int corners = 72) {
  Mesh mesh;
  std::vector<std::vector<std::uint32_t>> index;
  for (const Ring& ring : rings) {
    std::vector<std::uint32_t>& row = index.emplace_back();
    const bool point = ring.radius(0) == 0;
    for (int k = 0; k < corners; ++k) {
      if (!point || k == 0) {
        const double angle = 2 * std::numbers::pi * k / corners;
        mesh.vertices.emplace_back(ring.radius(angle) * std::cos(angle), ring.radius(angle) * std::sin(angle), ring.z);
      }
      row.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const auto &low = index[r], &high = index[(r + 1) % rings.size()];
    for (std::size_t k = 0; k < low.size(); ++k) {
      const std::size_t next = (k + 1) % low.size();
      add(low[k], low[next], high[next]);
      add(low[k], high[next], high[k]);
    }
  }
  return mesh;
}

/// Shank from 0 up to `length`, head above it, recess in the head.
struct ScrewMade {
  double diameter = 5, length = 20, head = 8.5, head_height = 5;
  Outline2 head_outline{};  ///< none: a circle
  Outline2 recess{};        ///< none: no recess
  double recess_depth = 0;
  double pitch = 0;          ///< > 0: the thread is modelled
  bool countersunk = false;  ///< `length` then includes the head
};

inline Mesh screw(const ScrewMade& s) {
  std::vector<Ring> rings{{0, circle(0)}, {0, circle(0.8 * s.diameter)}};
  const double shank = s.countersunk ? s.length - (s.head - s.diameter) / 2 : s.length;
  if (s.pitch > 0) {
    const ThreadOn thread{s.diameter, s.pitch};
    for (double z = 0.1 * s.diameter; z < 0.999 * shank; z += s.pitch / 8)
      rings.push_back({z, [=](double angle) { return thread.at(angle, z); }});
  } else {
    rings.push_back({0.1 * s.diameter, circle(s.diameter)});
  }
  rings.push_back({shank, circle(s.diameter)});
  const double top = s.countersunk ? s.length : s.length + s.head_height;
  const Outline2 head = s.head_outline ? s.head_outline : circle(s.head);
  if (s.head > 0 && !s.countersunk) rings.push_back({shank, head});
  rings.push_back({top, s.head > 0 ? head : circle(s.diameter)});
  if (s.recess) {
    rings.push_back({top, s.recess});
    rings.push_back({top - s.recess_depth, s.recess});
    rings.push_back({top - s.recess_depth, circle(0)});
  } else {
    rings.push_back({top, circle(0)});
  }
  return turned_solid(rings);
}

inline Mesh nut(const Outline2& outside, double hole, double height, double pitch = 0) {
  std::vector<Ring> rings{{0, outside}, {height, outside}};
  if (pitch > 0) {
    const ThreadOn thread{hole + 2 * 0.6134 * pitch, pitch};
    for (double z = height; z > 0; z -= pitch / 8)
      rings.push_back({z, [=](double angle) { return thread.at(angle, z); }});
    rings.push_back({0, circle(hole + pitch)});
  } else {
    rings.push_back({height, circle(hole)});
    rings.push_back({0, circle(hole)});
  }
  return turned_solid(rings);
}

inline Mesh ring(double outside, double hole, double height) { return nut(circle(outside), hole, height); }

/// The mesh turned by a random pose and scaled.
inline Mesh placed(Mesh mesh, std::mt19937_64& random, double scale) {
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  const Eigen::Vector3d shift = 20 * any();
  for (Eigen::Vector3d& p : mesh.vertices) p = scale * (turn * p + shift);
  return mesh;
}

/// The parts of a scene.
struct NamedMeshes {
  std::vector<Mesh> meshes;
  std::vector<std::string> names;
  PartId add(const std::string& name, Mesh mesh, const Eigen::Vector3d& at = Eigen::Vector3d::Zero()) {
    for (Eigen::Vector3d& p : mesh.vertices) p += at;
    meshes.push_back(std::move(mesh));
    names.push_back(name);
    return static_cast<PartId>(meshes.size() - 1);
  }
};

}  // namespace dismantle::fasteners::test
