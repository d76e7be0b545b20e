// Laws of the planner's geometry: graphs, distances until contact, directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "blocking/polyhedron.h"
#include "blocking/rotation_axes.h"
#include "blocking/translation_search.h"
#include "blocking_graph/directions.h"
#include "blocking_graph/graph.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

std::vector<std::vector<bool>> reach(const std::vector<std::vector<std::size_t>>& edges) {
  const std::size_t n = edges.size();
  std::vector<std::vector<bool>> r(n, std::vector<bool>(n, false));
  for (std::size_t i = 0; i < n; ++i) {
    r[i][i] = true;
    for (const std::size_t j : edges[i]) r[i][j] = true;
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) r[i][j] = r[i][j] || (r[i][k] && r[k][j]);
  return r;
}

TEST(BlockingGraph, FreeGroupsReachThemselvesAndNothingElse) {
  Rng rng(5);
  for (int trial = 0; trial < 500; ++trial) {
    const std::size_t n = 1 + rng.below(12);
    const double density = rng.uniform(0, 0.4);
    std::vector<std::vector<std::size_t>> edges(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j && rng.uniform() < density) edges[i].push_back(j);
    const auto reached = reach(edges);
    std::vector<std::vector<std::size_t>> expected;
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<std::size_t> group;
      bool closed = true;
      for (std::size_t j = 0; j < n; ++j) {
        if (reached[i][j]) group.push_back(j);
        closed = closed && (!reached[i][j] || reached[j][i]);
      }
      if (closed && group.front() == i && group.size() < n) expected.push_back(group);
    }
    std::size_t asked = 0;
    const auto found = free_groups(n, [&](std::size_t node, const auto& inside) -> std::optional<std::size_t> {
      ++asked;
      for (const std::size_t j : edges[node])
        if (!inside(j)) return j;
      return std::nullopt;
    });
    EXPECT_EQ(found, expected);
    EXPECT_LE(asked, 3 * n) << "each question finds a new node, closes a cycle, or is the node's last";
  }
}

/// The same for boxes, one axis at a time.
double way_of_boxes(const fake::Box& a, const fake::Box& b, const Vec3& offset, const Vec3& d) {
  double in = -std::numeric_limits<double>::infinity(), out = -in;
  for (int k = 0; k < 3; ++k) {
    const double lo = b.lo[k] - a.hi[k] - offset[k], hi = b.hi[k] - a.lo[k] - offset[k];
    if (d[k] == 0) {
      if (lo >= 0 || hi <= 0) return std::numeric_limits<double>::infinity();
    } else {
      in = std::max(in, std::min(lo / d[k], hi / d[k]));
      out = std::min(out, std::max(lo / d[k], hi / d[k]));
    }
  }
  return in < out && in >= 0 ? in : std::numeric_limits<double>::infinity();
}

TEST(Polyhedron, WayUntilContactIsThatOfBoxes) {
  Rng rng(6);
  const auto random_box = [&] {
    const Vec3 lo(std::round(rng.uniform(-3, 3)), std::round(rng.uniform(-3, 3)), std::round(rng.uniform(-3, 3)));
    return fake::Box{lo, lo + Vec3(1 + std::round(rng.uniform(0, 2)), 1 + std::round(rng.uniform(0, 2)), 1)};
  };
  int met = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const fake::Box a = random_box(), b = random_box();
    Vec3 offset = Vec3::Zero();
    if (trial % 2 == 0) offset = {rng.uniform(-4, 4), rng.uniform(-4, 4), rng.uniform(-4, 4)};
    const bool apart = (a.lo + offset - b.hi).maxCoeff() >= 0 || (b.lo - a.hi - offset).maxCoeff() >= 0;
    if (!apart) continue;
    Vec3 d = Vec3::Unit(static_cast<int>(rng.below(3))) * (rng.below(2) == 0 ? 1.0 : -1.0);
    if (trial % 3 == 0) d = Vec3(rng.normal(), rng.normal(), rng.normal()).normalized();
    const double inset = 0.003, tolerance = 0.001;
    const Polyhedron p(fake::boxes({a}), inset), q(fake::boxes({b}), inset);
    ASSERT_EQ(p.edges().size(), 12u);
    ASSERT_EQ(p.faces().size(), 6u);
    const double got = distance_until_contact(p, q, offset, d, tolerance);
    const auto shrunk = [&](const fake::Box& box, double by) {
      return fake::Box{box.lo + Vec3::Constant(by), box.hi - Vec3::Constant(by)};
    };
    // The result is between the distances of boxes shrunk by the inset and by the inset less the tolerance.
    const double late = way_of_boxes(shrunk(a, inset), shrunk(b, inset), offset, d);
    const double early = way_of_boxes(shrunk(a, inset - tolerance), shrunk(b, inset - tolerance), offset, d);
    EXPECT_LE(got, late + 1e-9);
    EXPECT_GE(got, early - 2 * tolerance / std::max(1e-3, d.cwiseAbs().minCoeff()) - 1e-9);
    met += std::isfinite(late) ? 1 : 0;
  }
  EXPECT_GT(met, 100);
}

TEST(Polyhedron, SubdividedFacesAreOneFace) {
  const Polyhedron two(fake::boxes({{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}}), 0.01);
  EXPECT_EQ(two.faces().size(), 12u);
  EXPECT_EQ(two.edges().size(), 24u);
  EXPECT_NEAR(two.box().lo.x(), 0.01, 1e-12);
  EXPECT_NEAR(two.box().hi.x(), 2.99, 1e-12);
}

/// The work is counted within an arrangement, too: with detailed parts, one takes longer than all that was planned.
TEST(TranslationSearch, EndsInTheMiddleOfAnArrangement) {
  const Assembly assembly = fake::tube_with_blocks(3);
  const PartialTranslationParameters params;
  TranslationSearch search(assembly, kDefaultTolerance, params);
  Places places;
  for (const Part& part : assembly.parts) places[part.id] = Eigen::Vector3d::Zero();
  const TranslationSearch::Answer cut = search.search(places, 100, 1.0, RunContext{});
  EXPECT_EQ(cut.end, TranslationSearch::End::too_long);
  EXPECT_EQ(cut.states, 1u);
  const TranslationSearch::Answer whole = search.search(places, 100, 1e9, RunContext{});
  EXPECT_EQ(whole.end, TranslationSearch::End::found) << "what was measured before is no hindrance";
}

/// Cubes in a closed box: a search that ends among the first moves is hopeless, one that got farther is not.
TEST(TranslationSearch, IsHopelessIfItEndsAmongTheFirstMoves) {
  Assembly assembly = fake::closed_box();
  assembly.parts.resize(4, assembly.parts.back());
  for (PartId id = 1; id < 4; ++id) {
    const double at = -1.7 + 1.1 * (id - 1.0);
    const Vec3 lo(at, at + 0.1, at - 0.05 * id);
    Part& cube = assembly.parts[id];
    cube.id = id;
    cube.mesh = cube.surface = std::make_shared<const Mesh>(fake::boxes({{lo, lo + Vec3::Ones()}}));
  }
  Places places;
  for (const Part& part : assembly.parts) places[part.id] = Vec3::Zero();
  bool any_hopeless = false, any_farther = false;
  for (double work = 1e3; work < 1e7; work *= 2) {
    TranslationSearch search(assembly, kDefaultTolerance, PartialTranslationParameters{});
    const TranslationSearch::Answer found = search.search(places, 1'000'000, work, RunContext{});
    EXPECT_NE(found.end, TranslationSearch::End::found);
    EXPECT_EQ(found.moves, 4u * 6);
    EXPECT_FALSE(any_farther && found.hopeless()) << work;
    any_hopeless = any_hopeless || found.hopeless();
    any_farther = any_farther || !found.hopeless();
  }
  EXPECT_TRUE(any_hopeless);
  EXPECT_TRUE(any_farther);
}

TEST(Directions, ComeInOppositePairsAndHoldTheNormalsOfFlatFaces) {
  const Assembly assembly = fake::tube_with_blocks(3);
  const Directions directions = directions_of(assembly);
  for (std::size_t d = 0; d < directions.all.size(); ++d) {
    EXPECT_NEAR(directions.all[d].norm(), 1, 1e-12);
    EXPECT_EQ(directions.all[Directions::opposite(d)], -directions.all[d]);
    for (std::size_t e = 0; e < d; ++e) EXPECT_LT(directions.all[d].dot(directions.all[e]), 1 - 1e-7);
  }
  for (const auto& list : directions.of_part)
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0})
        EXPECT_TRUE(std::any_of(list.begin(), list.end(),
                                [&](std::size_t d) { return directions.all[d].dot(sign * Vec3::Unit(k)) > 1 - 1e-9; }));
}

/// A prism over a regular polygon, without the part of it beyond x = `flat` (the radius is 1).
Mesh rod(int corners, double flat, double height) {
  Mesh mesh;
  for (const double z : {0.0, height})
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners;
      mesh.vertices.emplace_back(std::min(flat, std::cos(angle)), std::sin(angle), z);
    }
  const auto n = static_cast<std::uint32_t>(corners);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({k, next, n + k});
    mesh.triangles.push_back({next, n + next, n + k});
    if (k > 0 && next > 0) {
      mesh.triangles.push_back({0, next, k});
      mesh.triangles.push_back({n, n + k, n + next});
    }
  }
  return mesh;
}

TEST(TurningAxes, AreThoseOfRoundSurfacesWhereverTheyAre) {
  Rng rng(8);
  for (int trial = 0; trial < 40; ++trial) {
    Mesh mesh = rod(16 + static_cast<int>(rng.below(60)), rng.uniform(0.3, 0.7), rng.uniform(0.5, 5));
    const Pose at{Vec3(rng.normal(), rng.normal(), rng.normal()),
                  Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized()};
    for (auto& v : mesh.vertices) v = at * v;
    const auto axes = rotation_axes(mesh, 3, {});
    ASSERT_FALSE(axes.empty());
    const Vec3 true_axis = at.q * Vec3::UnitZ();
    EXPECT_GT(std::abs(axes[0].direction.dot(true_axis)), 1 - 1e-6);
    EXPECT_LT((axes[0].point - at.t).cross(true_axis).norm(), 1e-3);
  }
}

TEST(TurningAxes, NoneWhereTurningChangesNothingOrNothingIsRound) {
  for (const int corners : {24, 48, 97}) EXPECT_TRUE(rotation_axes(rod(corners, 2, 3), 3, {}).empty());
  EXPECT_TRUE(rotation_axes(fake::boxes({{{0, 0, 0}, {1, 2, 3}}, {{4, 0, 0}, {5, 1, 1}}}), 3, {}).empty());
}

}  // namespace
}  // namespace dismantle::blocking
