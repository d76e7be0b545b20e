// Surroundings of points: on combs of thin fins, in rooms, around tori.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/surface_query.h"
#include "test_solids.h"

namespace dismantle::sdf {
namespace {

using Eigen::Vector3d;

/// A bar along x with columns of `unit` width and random height: fins, slots and steps.
Mesh comb(Rng& rng, int columns, double unit) {
  std::vector<int> height;
  for (int i = 0; i < columns; ++i) height.push_back(1 + static_cast<int>(rng.below(4)));
  const auto filled = [&](int i, int k) {
    return i >= 0 && i < columns && k >= 0 && k < height[static_cast<std::size_t>(i)];
  };
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](int x, int y, int z) {
    const auto [at, fresh] = known.try_emplace({x, y, z}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.emplace_back(unit * x, 0.5 * y, unit * z);
    return at->second;
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < columns; ++i)
    for (int k = 0; filled(i, k); ++k) {
      if (!filled(i - 1, k)) quad(vertex(i, 0, k), vertex(i, 0, k + 1), vertex(i, 1, k + 1), vertex(i, 1, k));
      if (!filled(i + 1, k))
        quad(vertex(i + 1, 0, k), vertex(i + 1, 1, k), vertex(i + 1, 1, k + 1), vertex(i + 1, 0, k + 1));
      if (!filled(i, k - 1)) quad(vertex(i, 0, k), vertex(i, 1, k), vertex(i + 1, 1, k), vertex(i + 1, 0, k));
      if (!filled(i, k + 1))
        quad(vertex(i, 0, k + 1), vertex(i + 1, 0, k + 1), vertex(i + 1, 1, k + 1), vertex(i, 1, k + 1));
      quad(vertex(i, 0, k), vertex(i + 1, 0, k), vertex(i + 1, 0, k + 1), vertex(i, 0, k + 1));
      quad(vertex(i, 1, k), vertex(i, 1, k + 1), vertex(i + 1, 1, k + 1), vertex(i + 1, 1, k));
    }
  return mesh;
}

struct Surroundings {
  double certain = 0;
  std::vector<FacePlane> fronts, walls;

  Surroundings(const SurfaceQuery& query, const Vector3d& p, const Sample& sample, double reach) {
    FacePlane planes[kMaxPlanes], more[kMaxPlanes];
    const int edges = query.planes(p, sample, 2e-4, planes);
    fronts.push_back({sample.normal, sample.value});
    fronts.insert(fronts.end(), planes, planes + edges);
    int count = 0;
    certain = query.surroundings(p, fronts.data(), static_cast<int>(fronts.size()), reach, 2e-4, more, count);
    walls.assign(more, more + count);
  }
  /// True if it is in front of one of the point's own faces, and of all other reported faces.
  bool allows(const Vector3d& displacement) const {
    const auto clear = [&](const FacePlane& f) { return f.gap + f.normal.dot(displacement) >= 0; };
    return std::any_of(fronts.begin(), fronts.end(), clear) && std::all_of(walls.begin(), walls.end(), clear);
  }
};

/// Moves points near the surface as their surroundings allow. `deepest`: largest allowed depth. Returns the number of
/// motions.
int try_displacements(const Mesh& mesh, std::uint64_t seed, double deepest) {
  const auto solids = split_solids(mesh);
  const SurfaceQuery query(solids[0]);
  Rng rng(seed);
  Aabb around = mesh.box();
  around.inflate(0.02);
  int displacements = 0;
  for (int i = 0; i < 4000; ++i) {
    Vector3d p = test::random_point(rng, around);
    Sample sample = query.sample(p);
    if (rng.below(2) == 0) {  // onto the surface, or all but
      p -= sample.normal * (sample.value - (rng.below(2) == 0 ? 0.0 : 1e-5));
      sample = query.sample(p);
    }
    if (sample.value < 0 || sample.value > 0.05) continue;
    const Surroundings seen(query, p, sample, 0.05);
    EXPECT_LE(seen.certain, 0.05);
    for (const FacePlane& wall : seen.walls) EXPECT_GE(wall.gap, 0);
    for (int k = 0; k < 8; ++k) {
      const Vector3d displacement =
          Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized() * seen.certain * rng.uniform();
      if (!seen.allows(displacement)) continue;
      ++displacements;
      EXPECT_GE(query.sample(p + displacement).value, -deepest)
          << "from " << p.transpose() << " by " << displacement.transpose();
    }
  }
  return displacements;
}

TEST(Surroundings, WhatTheyAllowEntersNothing) {
  Rng rng(61);
  int displacements = 0;
  for (int i = 0; i < 6; ++i)
    displacements += try_displacements(comb(rng, 12, 0.03), 70 + static_cast<std::uint64_t>(i), 1e-6);
  displacements +=
      try_displacements(test::inside_out(test::box(Vector3d(-0.2, -0.1, -0.05), Vector3d(0.2, 0.1, 0.05))), 80, 1e-6);
  EXPECT_GT(displacements, 5000);
}

TEST(Surroundings, OnRoundSurfacesTheErrorIsThatOfTheBend) {
  // Motion 0.05, least radius 0.2: 0.05^2 / (2 * 0.2), and the same again for the facets.
  EXPECT_GT(try_displacements(test::torus(0.8, 0.2, 96, 48), 81, 0.0125), 500);
}

TEST(Surroundings, InACornerTheOtherWallIsTold) {
  const auto solids =
      split_solids(test::joined(test::box(Vector3d(-1, -1, -1), Vector3d(1, 1, 1)),
                                test::inside_out(test::box(Vector3d(-0.9, -0.9, -0.9), Vector3d(0.9, 0.9, 0.9)))));
  const SurfaceQuery query(solids[0]);
  const Vector3d p(0.87, 0.1, -0.9);  // on the floor, 0.03 from a wall
  const Sample sample = query.sample(p);
  const Surroundings seen(query, p, sample, 0.05);
  ASSERT_EQ(seen.walls.size(), 1u);
  EXPECT_LT((seen.walls[0].normal - Vector3d(-1, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(seen.walls[0].gap, 0.03, 1e-9);
  EXPECT_GT(seen.certain, 0.04);
}

}  // namespace
}  // namespace dismantle::sdf
