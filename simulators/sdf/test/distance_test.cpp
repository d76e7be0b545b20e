/// Laws of the exact query and of the grid, on solids that are thick, thin, round, threaded, hollow and joined.
#include <gtest/gtest.h>

#include "dismantle/sdf/distance_grid.h"
#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/surface_query.h"
#include "test_solids.h"

namespace dismantle::sdf {
namespace {

struct Case {
  const char* name;
  Mesh mesh;
};

std::vector<Case> cases() {
  using Eigen::Vector3d;
  return {
      {"box", test::box(Vector3d(-1, -0.5, -0.3), Vector3d(1, 0.7, 0.3))},
      {"plate thinner than a cell", test::box(Vector3d(-2, -2, 0), Vector3d(2, 2, 0.01))},
      {"needle", test::box(Vector3d(-3, 0, 0), Vector3d(3, 0.02, 0.015))},
      {"torus", test::torus(1.5, 0.4)},
      {"thin ring", test::torus(1.5, 0.03, 64, 8)},
      {"thread thinner than a cell", test::threaded_rod(0.4, 0.03, 1.2, 12)},
      {"hollow box",
       test::joined(test::box(Vector3d(-1, -1, -1), Vector3d(1, 1, 1)),
                    test::inside_out(test::box(Vector3d(-0.97, -0.97, -0.97), Vector3d(0.97, 0.97, 0.97))))},
  };
}

TEST(SurfaceQuery, ValueIsTheSignedDistanceWhateverTheHint) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    ASSERT_EQ(solids.size(), 1u);
    const SurfaceQuery query(solids[0]);
    Rng rng(7);
    Aabb around = c.mesh.box();
    around.inflate(0.2);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, around);
      const double w = test::winding(c.mesh, p);
      const double expected = test::distance(c.mesh, p) * (w > 0.5 ? -1 : 1);
      const Sample s = query.sample(p);
      ASSERT_NEAR(s.value, expected, 1e-9) << p.transpose();
      ASSERT_NEAR(s.normal.norm(), 1.0, 1e-9);
      const auto hint = static_cast<std::uint32_t>(rng.below(c.mesh.triangles.size()));
      const Sample t = query.sample(p, 1e9, hint);
      ASSERT_EQ(s.value, t.value);
      ASSERT_EQ(s.triangle, t.triangle);
    }
  }
}

TEST(SurfaceQuery, WithinTheFlatRadiusDistanceIsLinearAndNoConvexEdgeNear) {
  constexpr double kFromEdge = 2e-4;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    Rng rng(10);
    std::size_t flat = 0;
    for (int i = 0; i < 600; ++i) {
      // Near the surface, on both sides; a hint enables the lists.
      const std::size_t t = rng.below(c.mesh.triangles.size());
      const double u = rng.uniform(0, 1), v = rng.uniform(0, 1 - u);
      Eigen::Vector3d p = c.mesh.vertex(t, 0) + u * (c.mesh.vertex(t, 1) - c.mesh.vertex(t, 0)) +
                          v * (c.mesh.vertex(t, 2) - c.mesh.vertex(t, 0));
      for (int k = 0; k < 3; ++k) p[k] += rng.uniform(-0.02, 0.02);
      const auto hint = query.sample(p).triangle;
      const Sample s = query.sample(p, 0.5, hint, {0.05, kFromEdge});
      ASSERT_EQ(s.value, query.sample(p).value);
      ASSERT_EQ(query.sample(p, 0.5, hint).flat_radius, 0.0) << "not asked for";
      if (s.flat_radius == 0) continue;
      ++flat;
      FacePlane planes[kMaxPlanes];
      for (int j = 0; j < 20; ++j) {
        Eigen::Vector3d displacement(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
        displacement *= rng.uniform(0, 0.999) * s.flat_radius / std::max(1e-12, displacement.norm());
        const Sample other = query.sample(p + displacement);
        ASSERT_NEAR(other.value, s.value + s.normal.dot(displacement), 1e-6) << "flat radius " << s.flat_radius;
        ASSERT_EQ(query.planes(p + displacement, other, kFromEdge, planes), 0);
      }
    }
    if (std::string(c.name) == "box") {
      EXPECT_GT(flat, 300u);
    }
  }
}

TEST(SurfaceQuery, GradientIsTheDirectionOfSteepestAscent) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    Rng rng(8);
    Aabb around = c.mesh.box();
    around.inflate(0.1);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, around);
      const Sample s = query.sample(p);
      if (std::abs(s.value) < 1e-4) continue;
      const double h = 1e-6;
      // Along its own gradient a distance grows at rate one, except across a medial axis.
      const double rate = (query.sample(p + h * s.normal).value - s.value) / h;
      const double back = (s.value - query.sample(p - h * s.normal).value) / h;
      EXPECT_NEAR(std::max(rate, back), 1.0, 1e-3) << p.transpose();
    }
  }
}

TEST(SurfaceQuery, LimitedQueriesAnswerExactlyWithinTheLimit) {
  const auto solids = split_solids(test::torus(1.5, 0.4));
  const SurfaceQuery query(solids[0]);
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-0.6, 0.6));
    const double limit = rng.uniform(0.01, 0.5), full = query.sample(p).value;
    const Sample s = query.sample(p, limit);
    if (std::abs(full) < limit)
      EXPECT_EQ(s.value, full);
    else
      EXPECT_EQ(s.triangle, geometry::kNoIndex);
  }
}

TEST(DistanceGrid, SignIsRightWhereverTheSurfaceIsFurtherThanACell) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    const DistanceGrid grid(solids[0], query, {});
    Rng rng(9);
    Aabb around = c.mesh.box();
    around.inflate(0.3);
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, around);
      const double exact = query.sample(p).value;
      if (std::abs(exact) < 0.5 * grid.cell().norm()) continue;
      inside += exact < 0;
      EXPECT_EQ(grid.value(p) < 0, exact < 0) << p.transpose() << " exact " << exact << " grid " << grid.value(p);
    }
    if (std::string_view(c.name) == "box" || std::string_view(c.name) == "torus") {
      EXPECT_GT(inside, 50);
    }
  }
}

TEST(DistanceGrid, NodesOfTheBandAreExact) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    const DistanceGrid grid(solids[0], query, {});
    const double reach = grid.cell().maxCoeff();
    int checked = 0;
    Rng rng(4);
    for (int n = 0; n < 20000; ++n) {
      const int i = static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.nodes().x())));
      const int j = static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.nodes().y())));
      const int k = static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.nodes().z())));
      const Eigen::Vector3d p = grid.origin() + Eigen::Vector3d(i, j, k).cwiseProduct(grid.cell());
      const double exact = query.sample(p).value;
      if (std::abs(exact) > reach) continue;
      ++checked;
      ASSERT_NEAR(grid.node(i, j, k), exact, 1e-6);
    }
    EXPECT_GT(checked, 100);
  }
}

TEST(DistanceGrid, TrilinearErrorStaysBelowTheKnownBound) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    const DistanceGrid grid(solids[0], query, {});
    Rng rng(10);
    Aabb around = c.mesh.box();
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, around);
      const double exact = query.sample(p).value;
      if (std::abs(exact) > 0.3 * grid.cell().minCoeff()) continue;
      // Interpolating exact nodes of a 1-Lipschitz function: at most half the cell's diagonal.
      EXPECT_LE(std::abs(grid.value(p) - exact), 0.5 * grid.cell().norm() + 1e-6);
    }
  }
}

TEST(DistanceGrid, LowerBoundNeverExceedsTheDistance) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    const DistanceGrid grid(solids[0], query, {});
    Rng rng(11);
    Aabb around = c.mesh.box();
    around.inflate(2);
    double best_share = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, around);
      const double exact = std::max(0.0, query.sample(p).value);
      const double bound = grid.lower_bound(p);
      ASSERT_LE(bound, exact + 1e-9) << p.transpose();
      if (exact > 0.5) best_share = std::max(best_share, bound / exact);
    }
    EXPECT_GT(best_share, 0.5);  // a bound of nothing would cull nothing
  }
}

TEST(DistanceGrid, WithExactNodesTheBoundIsTightAndTheErrorKnownEverywhere) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solids = split_solids(c.mesh);
    const SurfaceQuery query(solids[0]);
    const DistanceGrid grid(solids[0], query, bounding_grid());
    const DistanceGrid fine(solids[0], query, {});
    EXPECT_LT(8 * grid.bytes(), fine.bytes());
    Rng rng(12);
    Aabb inner = c.mesh.box(), outer = inner;
    outer.inflate(2);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = test::random_point(rng, inner), q = test::random_point(rng, outer);
      const double exact = query.sample(p).value;
      ASSERT_NEAR(grid.value(p), exact, grid.error_near()) << p.transpose();
      ASSERT_LE(grid.lower_bound(p), std::max(0.0, exact)) << p.transpose();
      ASSERT_GE(grid.lower_bound(p), exact - 2 * grid.error_near() - 1e-4) << p.transpose();
      ASSERT_LE(grid.lower_bound(q), std::max(0.0, query.sample(q).value) + 1e-9) << q.transpose();
    }
  }
}

TEST(SplitSolids, OverlappingShellsAreSeparateSolidsAndVoidsStayWithTheirs) {
  using Eigen::Vector3d;
  const Mesh hollow = test::joined(test::box(Vector3d(-1, -1, -1), Vector3d(1, 1, 1)),
                                   test::inside_out(test::box(Vector3d(-.5, -.5, -.5), Vector3d(.5, .5, .5))));
  EXPECT_EQ(split_solids(hollow).size(), 1u);
  const Mesh two = test::joined(hollow, test::box(Vector3d(0.8, -0.2, -0.2), Vector3d(1.5, 0.2, 0.2)));
  const auto solids = split_solids(two);
  ASSERT_EQ(solids.size(), 2u);
  // The inside of their union is that of the winding number, also where the shells overlap.
  std::vector<SurfaceQuery> queries;
  for (const auto& s : solids) queries.emplace_back(s);
  Rng rng(5);
  Aabb around = two.box();
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = test::random_point(rng, around);
    double d = 1e9;
    for (const auto& q : queries) d = std::min(d, q.sample(p).value);
    EXPECT_EQ(d<0, test::winding(two, p)> 0.5) << p.transpose();
  }
}

}  // namespace
}  // namespace dismantle::sdf
