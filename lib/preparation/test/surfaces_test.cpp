// Surfaces that are not the boundary of one plain solid: open ones, pinched ones, T-junctions, shells that overlap.
#include <gtest/gtest.h>

#include <numbers>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/preparation/check_assembly.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

struct PreparedPart {
  Assembly assembly;
  PrepareReport report;
};

/// The part, next to a box far away.
PreparedPart prepare_part(Mesh mesh, PrepareOptions options = {}) {
  options.subdivide = 0;
  RunContext context;
  PreparedPart out;
  out.assembly = prepare_assembly({raw("part", std::move(mesh)), raw("far", box({50, 0, 0}, {51, 1, 1}))}, "made up", "0",
                                  options, context, out.report);
  return out;
}

Mesh without_triangles(Mesh mesh, std::vector<std::size_t> triangles) {
  std::sort(triangles.rbegin(), triangles.rend());
  for (const std::size_t t : triangles) mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  return mesh;
}

Mesh open_sheet() { return {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

/// Two tetrahedra that fill a bipyramid upside down: they touch at their tips.
Mesh hourglass() {
  Mesh m{{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}},
         {{1, 2, 3}, {0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {4, 6, 5}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}};
  return m;
}

/// A prism whose edge lies in the plane x = 0.
Mesh wedge() {
  return {{{0, 1, 1}, {1, 0.5, 1}, {1, 1.5, 1}, {0, 1, 2}, {1, 0.5, 2}, {1, 1.5, 2}},
          {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

/// The face `at` gets a vertex in the middle of its edge k, its neighbour does not: a T-junction.
Mesh split_edge(Mesh m, std::size_t at, std::size_t k) {
  const Triangle t = m.triangles[at];
  const auto middle = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.push_back(0.5 * (m.vertices[t[k]] + m.vertices[t[(k + 1) % 3]]));
  m.triangles[at] = {t[k], middle, t[(k + 2) % 3]};
  m.triangles.push_back({middle, t[(k + 1) % 3], t[(k + 2) % 3]});
  return m;
}

TEST(OpenSurfaces, AreKeptAsTheyAre) {
  const Mesh cube = box({0, 0, 0}, {2, 2, 2});
  const std::vector<Mesh> open = {without_triangles(cube, {10, 11}), without_triangles(cube, {0, 1, 2, 3}), open_sheet(),
                                  without_triangles(refine(cube, 2), {0, 9, 30, 31, 50, 90, 120}),
                                  joined(cube, without_triangles(box({1, 1, 2}, {3, 3, 4}), {10, 11}))};
  for (const Mesh& mesh : open) {
    PrepareOptions options;
    options.max_hole = 0;
    const auto [a, report] = prepare_part(split_vertices(mesh), options);
    ASSERT_EQ(a.parts.size(), 2U);
    EXPECT_TRUE(a.parts[0].open);
    EXPECT_FALSE(a.parts[1].open);
    EXPECT_EQ(a.parts[0].mesh->triangles.size(), mesh.triangles.size());
    EXPECT_NEAR(surface_area(*a.parts[0].mesh), surface_area(mesh) * std::pow(a.normalization.scale, 2), 1e-9);
    EXPECT_NE(report.parts[0].open.find("not watertight"), std::string::npos);
    EXPECT_TRUE(a.overlaps.empty());
    EXPECT_EQ(check_parts(report).count(Severity::error), 0U);
    options.open = OpenSurfaces::exclude;
    EXPECT_NE(input_error([&] { prepare_part(mesh, options); }).find("1 of 2 parts can be used"), std::string::npos);
  }
}

TEST(OpenSurfaces, NoWallIsMadeUpAndNoneIsLost) {
  // A fin on a box: three triangles meet in an edge, and repair of a solid drops the fin.
  Mesh finned = without_triangles(box({0, 0, 0}, {2, 2, 2}), {10, 11});
  const auto n = static_cast<std::uint32_t>(finned.vertices.size());
  finned.vertices.insert(finned.vertices.end(), {{0, 0, -2}, {2, 0, -2}});
  std::uint32_t left = 0, right = 0;
  for (std::uint32_t v = 0; v < n; ++v) {
    if (finned.vertices[v].isApprox(Vec3(0, 0, 0)) || finned.vertices[v].isZero()) left = v;
    if (finned.vertices[v].isApprox(Vec3(2, 0, 0))) right = v;
  }
  finned.triangles.push_back({left, right, n});
  finned.triangles.push_back({right, n + 1, n});
  const auto [a, report] = prepare_part(finned);
  EXPECT_TRUE(a.parts[0].open);
  EXPECT_EQ(a.parts[0].mesh->triangles.size(), finned.triangles.size());
  EXPECT_TRUE(report.parts[0].actions.empty()) << report.parts[0].actions.front();
}

TEST(OpenSurfaces, InsideOutOnesAreTurned) {
  const auto [a, report] = prepare_part(inside_out(without_triangles(box({0, 0, 0}, {2, 2, 2}), {10, 11})));
  EXPECT_TRUE(a.parts[0].open);
  EXPECT_GT(signed_volume(*a.parts[0].mesh), 0);
}

struct Known {
  std::string name;
  Mesh mesh;
  double volume;
};

void expect_known(const std::vector<Known>& cases) {
  for (const Known& known : cases) {
    for (const bool stl : {false, true}) {
      const auto [a, report] = prepare_part(stl ? split_vertices(known.mesh) : known.mesh);
      ASSERT_EQ(a.parts.size(), 2U) << known.name;
      EXPECT_FALSE(a.parts[0].open) << known.name << ": " << report.parts[0].open;
      EXPECT_TRUE(report.parts[0].watertight) << known.name;
      EXPECT_NEAR(report.parts[0].volume, known.volume, 1e-9 * known.volume) << known.name << (stl ? ", split" : "");
    }
  }
}

TEST(PinchedSurfaces, EdgesKeepTheirVolume) {
  const Mesh a = box({0, 0, 0}, {1, 1, 1});
  expect_known({
      {"two boxes along an edge", joined(a, box({1, 1, 0}, {2, 2, 1})), 2},
      {"a shorter edge", joined(a, box({1, 1, 0}, {3, 3, 1})), 5},
      {"a stair of three", joined(joined(a, box({1, 1, 0}, {2, 2, 1})), box({2, 2, 0}, {3, 3, 1})), 3},
      {"four around an edge", joined(joined(a, box({1, 1, 0}, {2, 2, 1})),
                                     joined(box({0, 2, 0}, {1, 3, 1}), box({-1, 1, 0}, {0, 2, 1}))), 4},
      {"a void that touches the outside", joined(box({0, 0, 0}, {3, 3, 3}), inside_out(wedge())), 26.5},
  });
}

TEST(PinchedSurfaces, CornersKeepTheirVolume) {
  const Mesh a = box({0, 0, 0}, {1, 1, 1});
  expect_known({
      {"two boxes at a corner", joined(a, box({1, 1, 1}, {2, 2, 2})), 2},
      {"boxes of two sizes", joined(a, box({1, 1, 1}, {3, 3, 3})), 9},
      {"a chain of three", joined(joined(a, box({1, 1, 1}, {2, 2, 2})), box({2, 2, 2}, {3, 3, 3})), 3},
      {"an hourglass", hourglass(), 1},
      {"a void at a corner", joined(box({0, 0, 0}, {3, 3, 3}), inside_out(box({1, 1, 1}, {2, 2, 2}))), 26},
  });
}

TEST(TJunctions, KeepTheVolume) {
  const Mesh cube = box({0, 0, 0}, {2, 2, 2});
  Mesh half = refine(cube, 1);
  for (std::size_t t = 0; t < 8; ++t) half = split_edge(half, t, t % 3);
  expect_known({
      {"one edge", split_edge(cube, 0, 1), 8},
      {"two edges of a face", split_edge(split_edge(cube, 0, 0), 1, 1), 8},
      {"twice on an edge", split_edge(split_edge(cube, 0, 1), 0, 0), 8},
      {"many edges", half, 8},
      {"a tube", split_edge(split_edge(tube(1, 2, 0, 3, 24), 5, 0), 40, 2), volume(tube(1, 2, 0, 3, 24))},
  });
}

/// The volume of all cells of a lattice whose centre is inside: exact for boxes with corners on the lattice.
double volume_inside(const PreparedPart& part) {
  const TriangleBvh solid(*part.assembly.parts[0].mesh);
  const double cell = 0.5;
  std::size_t inside = 0;
  for (double x = -4 + cell / 2; x < 7; x += cell)
    for (double y = -4 + cell / 2; y < 7; y += cell)
      for (double z = -4 + cell / 2; z < 7; z += cell)
        if (solid.inside(part.assembly.normalization.to_internal({x, y, z}))) ++inside;
  return static_cast<double>(inside) * cell * cell * cell;
}

TEST(OverlappingShells, AreKeptAndTakenAsTheirUnion) {
  const Mesh a = box({0, 0, 0}, {2, 2, 2});
  const std::vector<Known> cases = {
      {"corner in corner", joined(a, box({1, 1, 1}, {3, 3, 3})), 8 + 8 - 1},
      {"a cross", joined(box({-3, -1, -1}, {3, 1, 1}), box({-1, -3, -1}, {1, 3, 1})), 24 + 24 - 8},
      {"a peg through a plate", joined(box({0, 0, 0}, {6, 6, 1}), box({2, 2, -2}, {4, 4, 3})), 36 + 20 - 4},
      {"a chain", joined(joined(a, box({1, 0.5, 0.5}, {4, 1.5, 1.5})), box({3, 0, 0}, {5, 2, 2})), 8 + 3 + 8 - 2},
      {"one in the other", joined(box({0, 0, 0}, {4, 4, 4}), box({1, 1, 1}, {2, 2, 2})), 64}};
  for (const Known& known : cases) {
    for (const bool stl : {false, true}) {
      const PreparedPart made = prepare_part(stl ? split_vertices(known.mesh) : known.mesh);
      ASSERT_EQ(made.assembly.parts.size(), 2U) << known.name;
      EXPECT_FALSE(made.assembly.parts[0].open) << known.name;
      EXPECT_TRUE(made.report.parts[0].watertight) << known.name;
      EXPECT_EQ(volume_inside(made), known.volume) << known.name << (stl ? ", split" : "");
    }
  }
}

}  // namespace
}  // namespace dismantle
