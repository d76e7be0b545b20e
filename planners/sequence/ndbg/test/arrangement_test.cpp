// Laws of arrangements of great circles.
#include "ndbg/arrangement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "dismantle/testing/shapes.h"

namespace dismantle::ndbg {
namespace {

using Eigen::Vector3d;

std::vector<int> signs_of(const std::vector<Vector3d>& normals, const Vector3d& d) {
  std::vector<int> signs;
  for (const Vector3d& n : normals) signs.push_back(std::abs(n.dot(d)) < 1e-6 ? 0 : n.dot(d) < 0 ? -1 : 1);
  return signs;
}

std::vector<Vector3d> random_normals(std::size_t count, Rng& rng) {
  std::vector<Vector3d> normals;
  while (normals.size() < count) normals.push_back(shapes::random_vector(rng, -1, 1).normalized());
  return normals;
}

/// Every other arrangement has circles that cross in common points, as those of a machined part do.
std::vector<Vector3d> normals_of_trial(int trial, Rng& rng) {
  std::vector<Vector3d> normals = random_normals(3 + rng.below(6), rng);
  if (trial % 2 == 0) return normals;
  normals = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  const Vector3d more[] = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {0, 1, 2}, {1, 1, 1}};
  for (const Vector3d& n : more)
    if (rng.below(2) == 0) normals.push_back(n.normalized());
  return normals;
}

/// Euler's formula, for any circles; as many cells of each kind on one side as on the other.
TEST(Arrangement, ObeysEulersFormula) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto normals = normals_of_trial(trial, rng);
    const Arrangement a = arrangement_of(normals);
    EXPECT_EQ(
        static_cast<long>(a.vertices.size()) - static_cast<long>(a.arcs.size()) + static_cast<long>(a.faces.size()), 2);
    for (const auto* cells : {&a.vertices, &a.arcs, &a.faces})
      for (const Vector3d& d : *cells) {
        EXPECT_NEAR(d.norm(), 1, 1e-12);
        EXPECT_TRUE(std::any_of(cells->begin(), cells->end(), [&](const Vector3d& e) { return e.dot(d) < -1 + 1e-9; }));
      }
  }
}

/// A vertex is on two circles at least, a direction of an arc on one, of a face on none; no cell has two directions.
TEST(Arrangement, HasOneDirectionOfEachCell) {
  Rng rng(2);
  for (int trial = 0; trial < 200; ++trial) {
    const auto normals = normals_of_trial(trial, rng);
    const Arrangement a = arrangement_of(normals);
    std::set<std::vector<int>> cells;
    const auto expect = [&](const std::vector<Vector3d>& list, int least, int most) {
      for (const Vector3d& d : list) {
        const auto signs = signs_of(normals, d);
        const auto on = std::count(signs.begin(), signs.end(), 0);
        EXPECT_GE(on, least);
        EXPECT_LE(on, most);
        EXPECT_TRUE(cells.insert(signs).second);
      }
    };
    expect(a.vertices, 2, static_cast<int>(normals.size()));
    expect(a.arcs, 1, 1);
    expect(a.faces, 0, 0);
    // Every random direction is in a known cell.
    for (int k = 0; k < 200; ++k)
      EXPECT_TRUE(cells.contains(signs_of(normals, shapes::random_vector(rng, -1, 1).normalized())));
    for (const Vector3d& n : normals) {
      const Vector3d u = n.unitOrthogonal(), v = n.cross(u);
      const double angle = rng.uniform(0, 6.28);
      EXPECT_TRUE(cells.contains(signs_of(normals, std::cos(angle) * u + std::sin(angle) * v)));
    }
  }
}

TEST(Arrangement, IsEmptyWhereTheNormalsLieInAPlane) {
  const std::vector<Vector3d> flat{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d(1, 1, 0).normalized()};
  for (std::size_t count = 0; count <= flat.size(); ++count) {
    const Arrangement a = arrangement_of({flat.begin(), flat.begin() + static_cast<std::ptrdiff_t>(count)});
    EXPECT_TRUE(a.vertices.empty() && a.arcs.empty() && a.faces.empty());
  }
}

}  // namespace
}  // namespace dismantle::ndbg
