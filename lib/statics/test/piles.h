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
