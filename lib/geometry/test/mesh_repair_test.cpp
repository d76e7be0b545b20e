#include "dismantle/geometry/mesh_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

TEST(Weld, UndoesSplittingOfVertices) {
  Rng rng(1);
  for (int round = 0; round < 30; ++round) {
    const Mesh original = random_solid(rng);
    Mesh m = split_vertices(original);
    const WeldResult r = weld(m, 1e-6 * m.box().size().norm());
    EXPECT_EQ(m.vertices.size(), original.vertices.size());
    ASSERT_EQ(m.triangles.size(), original.triangles.size());
    EXPECT_EQ(r.merged, 3 * original.triangles.size() - original.vertices.size());
    EXPECT_EQ(r.degenerate, 0u);
    EXPECT_TRUE(edge_use(m).closed());
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(m.vertex(t, c), original.vertex(t, c));
  }
}

TEST(Weld, ClosesNoisySeams) {
  Rng rng(2);
  for (int round = 0; round < 20; ++round) {
    const Mesh original = random_solid(rng);
    const double size = original.box().size().norm();
    Mesh m = split_vertices(original);
    for (auto& v : m.vertices) v += random_vector(rng, -1e-8, 1e-8) * size;
    EXPECT_GT(edge_use(m).open, 0u);
    weld(m, 1e-6 * size);
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_EQ(m.vertices.size(), original.vertices.size());
  }
}

TEST(Weld, NeverCollapsesDetailOfAClosedSurface) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  append(m, box({2, 2, 2}, {2 + 1e-9, 2 + 1e-9, 2 + 1e-9}));  // far below the tolerance, but closed
  weld(m, 1e-3);
  EXPECT_EQ(m.triangles.size(), 24u);
  EXPECT_EQ(m.vertices.size(), 16u);
}

TEST(Weld, DropsDegenerateTrianglesAndUnusedVertices) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  m.vertices.push_back({9, 9, 9});
  m.triangles.push_back({0, 0, 5});
  m.triangles.push_back({1, 2, 1});
  const WeldResult r = weld(m, 0);
  EXPECT_EQ(r.degenerate, 2u);
  EXPECT_EQ(r.unused, 1u);
  EXPECT_EQ(m.triangles.size(), 12u);
  EXPECT_EQ(m.vertices.size(), 8u);
}

/// Exactly the equal vertices are merged, and 0 equals -0.
TEST(Weld, WithoutAToleranceEqualPositionsAreOne) {
  Rng rng(3);
  const std::vector<double> coordinates{0.0, -0.0, 1.0, 1.0 + 1e-15, 1e-300, -1e-300};
  for (int round = 0; round < 50; ++round) {
    Mesh m;
    const std::size_t triangles = 1 + rng.below(200);
    const auto any = [&] { return coordinates[rng.below(coordinates.size())]; };
    for (std::uint32_t t = 0; t < triangles; ++t) {
      for (int c = 0; c < 3; ++c) m.vertices.emplace_back(any(), any(), static_cast<double>(rng.below(3)));
      m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const Mesh before = m;
    const WeldResult r = weld(m, 0);
    for (std::size_t a = 0; a < m.vertices.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) ASSERT_NE(m.vertices[a], m.vertices[b]);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles; ++t) {
      const auto &a = before.vertex(t, 0), &b = before.vertex(t, 1), &c = before.vertex(t, 2);
      if (a == b || b == c || c == a) continue;
      for (int k = 0; k < 3; ++k) ASSERT_EQ(m.vertex(kept, k), before.vertex(t, k));
      ++kept;
    }
    EXPECT_EQ(m.triangles.size(), kept);
    EXPECT_EQ(r.degenerate, triangles - kept);
  }
}

TEST(MeshEdges, AreInTheOrderOfTheirVertices) {
  Rng rng(4);
  for (int round = 0; round < 50; ++round) {
    Mesh m;
    const std::size_t vertices = 3 + rng.below(40);
    m.vertices.resize(vertices);
    const auto any = [&] { return static_cast<std::uint32_t>(rng.below(vertices)); };
    for (std::size_t t = rng.below(100); t-- > 0;) m.triangles.push_back({any(), any(), any()});
    const auto edges = mesh_detail::sorted_edges(m);
    ASSERT_EQ(edges.size(), 3 * m.triangles.size());
    const auto key = [](const auto& e) { return std::tuple(e.lo, e.hi, e.triangle, e.corner); };
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const auto& e = edges[k];
      if (k > 0) {
        ASSERT_LT(key(edges[k - 1]), key(e));  // so none is there twice
      }
      const Triangle& t = m.triangles[e.triangle];
      const std::uint32_t a = t[e.corner], b = t[(e.corner + 1) % 3];
      ASSERT_EQ(std::tuple(e.lo, e.hi, e.forward), std::tuple(std::min(a, b), std::max(a, b), a < b));
    }
  }
}

TEST(DuplicateFaces, CopiesGoAndTheWindingNumberStays) {
  Rng rng(3);
  for (int round = 0; round < 20; ++round) {
    const Mesh original = random_solid(rng);
    Mesh m = original;
    for (int k = 0; k < 10; ++k) m.triangles.push_back(original.triangles[rng.below(original.triangles.size())]);
    const DuplicateFaces d = drop_duplicate_faces(m);
    EXPECT_EQ(d.repeated, 10u);
    EXPECT_EQ(d.cancelled, 0u);
    EXPECT_FALSE(d.double_sided);
    EXPECT_EQ(m.triangles, original.triangles);
  }
}

TEST(DuplicateFaces, AWallBetweenTwoSolidsGoes) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  append(m, box({1, 0, 0}, {2, 1, 1}));
  weld(m, 0);
  // The triangulations of the shared wall must agree for the faces to be the same.
  const DuplicateFaces d = drop_duplicate_faces(m);
  if (d.cancelled) {
    EXPECT_EQ(d.cancelled, 4u);
    EXPECT_TRUE(edge_use(m).closed());
  }
  EXPECT_NEAR(signed_volume(m), 2, 1e-12);
}

TEST(DuplicateFaces, DoubleSidedSurfacesKeepOneSide) {
  Rng rng(4);
  Mesh m = random_solid(rng);
  const std::size_t n = m.triangles.size();
  for (std::size_t t = 0; t < n; ++t) {
    m.triangles.push_back(m.triangles[t]);
    flip(m, m.triangles.size() - 1);
  }
  const DuplicateFaces d = drop_duplicate_faces(m);
  EXPECT_TRUE(d.double_sided);
  EXPECT_EQ(m.triangles.size(), n);
  orient_outward(m);
  EXPECT_TRUE(edge_use(m).closed());
  EXPECT_GT(signed_volume(m), 0);
}

TEST(OrientOutward, RestoresRandomlyFlippedFaces) {
  Rng rng(5);
  for (int round = 0; round < 40; ++round) {
    const Mesh original = random_solid(rng);
    Mesh m = original;
    const double share = rng.uniform();
    std::size_t flipped = 0;
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      if (rng.uniform() < share) {
        flip(m, t);
        ++flipped;
      }
    const OrientResult r = orient_outward(m);
    EXPECT_EQ(r.flipped, flipped);
    EXPECT_EQ(r.membranes, 0u);
    EXPECT_FALSE(r.one_sided);
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
      Triangle a = m.triangles[t], b = original.triangles[t];
      std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
      std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
      ASSERT_EQ(a, b);
    }
  }
}

TEST(OrientOutward, InnerWallsAndFinsGo) {
  Rng rng(6);
  for (int round = 0; round < 20; ++round) {
    // Two boxes in one outline with a wall between them, and a fin outside.
    Mesh m;
    for (int x = 0; x < 3; ++x)
      for (int i = 0; i < 4; ++i) m.vertices.emplace_back(x, i & 1, i >> 1);
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      m.triangles.push_back({a, b, c});
      m.triangles.push_back({a, c, d});
    };
    quad(0, 1, 3, 2);
    quad(4, 5, 7, 6);  // the wall
    quad(8, 9, 11, 10);
    for (std::uint32_t b : {0u, 4u}) {
      quad(b, b + 1, b + 5, b + 4);
      quad(b + 1, b + 3, b + 7, b + 5);
      quad(b + 3, b + 2, b + 6, b + 7);
      quad(b + 2, b, b + 4, b + 6);
    }
    m.vertices.emplace_back(1, 0.5, 3);
    m.triangles.push_back({6, 7, 12});  // the fin
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      if (rng.below(2)) flip(m, t);
    m = moved(m, random_pose(rng, 3));
    const OrientResult r = orient_outward(m);
    EXPECT_EQ(r.membranes, 3u);
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_NEAR(signed_volume(m), 2, 1e-9);
  }
}

TEST(OrientOutward, SaysWhenASurfaceHasOneSide) {
  Mesh m;  // Moebius strip of five quads
  constexpr std::uint32_t n = 5;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n, half = a / 2;
    for (const double s : {-0.3, 0.3})
      m.vertices.emplace_back((1 + s * std::cos(half)) * std::cos(a), (1 + s * std::cos(half)) * std::sin(a),
                              s * std::sin(half));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t a = 2 * i, b = 2 * i + 1, c = 2 * ((i + 1) % n), d = c + 1;
    if (i + 1 == n) std::swap(c, d);
    m.triangles.push_back({a, c, b});
    m.triangles.push_back({b, c, d});
  }
  EXPECT_TRUE(orient_outward(m).one_sided);
}

TEST(OrientShells, NestingDecides) {
  const Mesh outer = box({-2, -2, -2}, {2, 2, 2}), inner = box({-1, -1, -1}, {1, 1, 1});
  const auto build = [&](bool flip_outer, bool flip_inner) {
    Mesh m;
    append(m, outer, flip_outer);
    append(m, inner, flip_inner);
    return m;
  };
  {  // a void stays a void
    Mesh m = build(false, true);
    const ShellResult r = orient_shells(m, true);
    EXPECT_EQ(r.voids, 1u);
    EXPECT_EQ(r.turned, 0u);
    EXPECT_NEAR(signed_volume(m), 64 - 8, 1e-12);
  }
  {  // an insert stays an insert
    Mesh m = build(false, false);
    const ShellResult r = orient_shells(m, true);
    EXPECT_EQ(r.inner_solids, 1u);
    EXPECT_EQ(r.turned, 0u);
  }
  {  // a part that is inside out as a whole keeps its void
    Mesh m = build(true, false);
    const ShellResult r = orient_shells(m, true);
    EXPECT_EQ(r.turned, 2u);
    EXPECT_EQ(r.voids, 1u);
    EXPECT_NEAR(signed_volume(m), 64 - 8, 1e-12);
  }
  {  // without a hint the nested one is a void
    Mesh m = build(false, false);
    const ShellResult r = orient_shells(m, false);
    EXPECT_EQ(r.voids, 1u);
    EXPECT_NEAR(signed_volume(m), 64 - 8, 1e-12);
  }
  {  // side by side: both outward
    Mesh m;
    append(m, outer, true);
    append(m, moved(inner, shift({10, 0, 0})), false);
    EXPECT_EQ(orient_shells(m, true).turned, 1u);
    EXPECT_NEAR(signed_volume(m), 64 + 8, 1e-12);
  }
  {  // partly overlapping shells are two solids
    Mesh m;
    append(m, outer);
    append(m, moved(inner, shift({2, 0, 0})));
    const ShellResult r = orient_shells(m, true);
    EXPECT_EQ(r.voids + r.inner_solids + r.turned, 0u);
  }
}

TEST(TJunctions, AreClosed) {
  Rng rng(8);
  for (int round = 0; round < 30; ++round) {
    const Mesh whole = random_solid(rng);
    Mesh m = whole;
    // Split edges on one side only.
    for (int k = 0; k < 5; ++k) {
      const auto t = rng.below(whole.triangles.size());
      const auto v = static_cast<std::uint32_t>(m.vertices.size());
      const Triangle old = m.triangles[t];
      const double u = rng.uniform(0.2, 0.8);
      m.vertices.push_back((1 - u) * m.vertices[old[0]] + u * m.vertices[old[1]]);
      m.triangles[t] = {old[0], v, old[2]};
      m.triangles.push_back({v, old[1], old[2]});
    }
    EXPECT_GT(edge_use(m).open, 0u);
    EXPECT_GT(close_t_junctions(m, 1e-9 * m.box().size().norm()), 0u);
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_NEAR(signed_volume(m), signed_volume(whole), 1e-9);
  }
}

}  // namespace
}  // namespace dismantle
