/// Shapes and piles for tests.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "dismantle/statics/contacts.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics::testing {

/// Closed solid with the corners of a box, each moved by `shape`.
template <class F>
Mesh bent_box(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi, F&& shape) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back(
        shape(Eigen::Vector3d(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z())));
  m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}
inline Mesh box(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  return bent_box(lo, hi, [](const Eigen::Vector3d& p) { return p; });
}

inline Mesh ground() { return box({-5, -5, -1}, {5, 5, 0}); }

/// Random blocks on each other, by a grid, so that they touch.
inline std::vector<Mesh> random_blocks(std::mt19937& random, int n) {
  std::vector<Mesh> meshes = {ground()};
  std::vector<double> top(8, 0.0);
  for (int k = 0; k < n; ++k) {
    const int at = static_cast<int>(random() % 8), wide = 1 + static_cast<int>(random() % 3);
    double z = 0;
    for (int x = at; x < std::min(8, at + wide); ++x) z = std::max(z, top[static_cast<std::size_t>(x)]);
    const double height = 0.5 * (1 + static_cast<double>(random() % 3));
    for (int x = at; x < std::min(8, at + wide); ++x) top[static_cast<std::size_t>(x)] = z + height;
    meshes.push_back(box({at - 4.0, 0, z}, {std::min(8, at + wide) - 4.0, 1, z + height}));
  }
  return meshes;
}

/// Random boxes on a ground: each on what is under it, some of them on two or three others.
inline std::vector<Mesh> random_boxes(std::mt19937& random, int n) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Mesh> meshes{box({-8, -8, -1}, {8, 8, 0})};
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3d half(0.4 + 0.8 * unit(random), 0.4 + 0.8 * unit(random),
                               0.2 + 0.1 * static_cast<double>(random() % 3));
    Eigen::Vector3d at(6 * unit(random) - 3, 6 * unit(random) - 3, 0);
    if (k > 0 && unit(random) < 0.7) {  // near the middle of another
      const Aabb other = meshes[1 + random() % static_cast<unsigned>(k)].box();
      for (int axis = 0; axis < 2; ++axis)
        at[axis] = other.center()[axis] + 0.3 * (unit(random) - 0.5) * other.size()[axis];
    }
    for (std::size_t i = 1; i < meshes.size(); ++i) {
      const Aabb under = meshes[i].box();
      const Eigen::Vector3d apart = (under.center() - at).cwiseAbs() - half - 0.5 * under.size();
      if (apart.x() < 0 && apart.y() < 0) at.z() = std::max(at.z(), under.hi.z());
    }
    at.z() += half.z();
    meshes.push_back(box(at - half, at + half));
  }
  return meshes;
}

/// Density 1; the first `fixed` meshes do not move.
inline Pile pile_of(const std::vector<Mesh>& meshes, std::size_t fixed, double friction, double touching = kTouching) {
  std::vector<Shape> shapes;
  Pile pile;
  for (const Mesh& m : meshes) {
    shapes.emplace_back(m);
    pile.bodies.push_back(
        {shapes.back().volume(), shapes.back().center(), shapes.back().radius(), pile.bodies.size() < fixed});
  }
  for (std::uint32_t i = 0; i < shapes.size(); ++i)
    for (std::uint32_t j = i + 1; j < shapes.size(); ++j)
      for (Contact& c : contacts_between({&shapes[i], {}}, {&shapes[j], {}}, touching)) {
        c.a = i;
        c.b = j;
        c.friction = friction;
        pile.contacts.push_back(std::move(c));
      }
  return pile;
}

}  // namespace dismantle::statics::testing
