#include "solid/pinches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/pair_check.h"
#include "dismantle/testing/voxels.h"

namespace dismantle::geometry {
namespace {

using voxels::Cell;
using voxels::Piece;

Piece random_cells(Rng& rng, int size, double share) {
  Piece piece;
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z)
        if (rng.uniform() < share) piece.push_back({x, y, z});
  if (piece.empty()) piece.push_back({0, 0, 0});
  return piece;
}

/// Directed edges that more than one triangle has.
std::size_t pinched_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  std::size_t count = 0;
  for (const auto& [edge, uses] : edges) {
    EXPECT_EQ(uses, edges[std::pair(edge.second, edge.first)]) << "not closed";
    count += uses > 1 ? 1 : 0;
  }
  return count;
}

TEST(Pinches, AreDividedAndTheSurfaceStaysClosedAndWhereItIs) {
  Rng rng(41);
  std::size_t before = 0, after = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Mesh mesh = voxels::surface(random_cells(rng, 3, rng.uniform(0.1, 0.9)));
    const Mesh divided = without_pinches(mesh);
    ASSERT_EQ(mesh.triangles.size(), divided.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.vertex(t, k), divided.vertex(t, k));
    const std::size_t own_before = pinched_edges(mesh), own_after = pinched_edges(divided);
    EXPECT_LE(own_after, own_before);
    if (own_before == 0 && divided.vertices.size() == mesh.vertices.size()) {
      EXPECT_EQ(divided.triangles, mesh.triangles);
    }
    before += own_before;
    after += own_after;
  }
  EXPECT_GT(before, 100u);
  // What is left: one fan of triangles that passes the same edge twice, at both of its ends.
  EXPECT_LT(10 * after, before);
}

/// Material on both sides of a pinched edge is apart once surfaces move inwards: two cubes joined along an edge are two
/// surfaces, and two holes that meet along an edge leave one.
TEST(Pinches, MaterialDecidesWhatBelongsTogether) {
  const auto sheets = [](const Piece& piece) {
    std::size_t count = 0;
    shells_of(without_pinches(voxels::surface(piece)), count);
    return count;
  };
  EXPECT_EQ(sheets({{0, 0, 0}, {1, 1, 0}}), 2u);
  EXPECT_EQ(sheets({{0, 0, 0}, {1, 1, 1}}), 2u);
  EXPECT_EQ(sheets({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}), 1u);
  EXPECT_EQ(sheets({{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), 1u);
}

/// A piece with a pinched edge passes what it touches without play. Without vertices of their own, the two wedges have
/// no common direction inwards, and the check found no proof.
TEST(Pinches, PiecesThatTouchThemselvesPassWithoutPlay) {
  Rng rng(42);
  int passed = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Piece all = random_cells(rng, 3, rng.uniform(0.15, 0.6));
    Piece a, b;
    for (const Cell& c : all) (rng.below(2) == 0 ? a : b).push_back(c);
    if (a.empty() || b.empty()) continue;
    const std::set<Cell> fixed(b.begin(), b.end());
    const int axis = static_cast<int>(rng.below(3));
    bool free = true;
    for (int steps = 1; steps <= 3 && free; ++steps)
      for (const Cell& c : a) free = free && !fixed.contains(voxels::moved(c, axis, steps));
    Limits limits;
    limits.penetration = 0.003;
    Pose end;
    end.t[axis] = 3;
    const auto solids = [](const Piece& piece) {
      auto list = split_into_solids(voxels::surface(piece));
      for (Solid& s : list) s.measure_thickness(1);
      return list;
    };
    // The frames of solids along the axes are identities.
    EXPECT_EQ(passes(solids(a), {Pose{}, end}, solids(b), Pose{}, limits), free) << trial;
    (free ? passed : refused) += 1;
  }
  EXPECT_GT(passed, 10);
  EXPECT_GT(refused, 50);
}

/// A ring of blocks that is cut where its ends meet: `gap` more than a turn (negative: less than one).
Mesh cut_ring(int blocks, double gap) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi + gap;
  for (int k = 0; k <= blocks; ++k)
    for (const double z : {0.0, 1.0})
      for (const double radius : {2.0, 3.0}) {
        const double angle = k == blocks && gap == 0 ? 0 : turn * k / blocks;
        mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(blocks); ++k) {
    const std::uint32_t a = 4 * k, b = a + 4;  // + 1: outside, + 2: above
    quad(a, b, b + 1, a + 1);
    quad(a + 2, a + 3, b + 3, b + 2);
    quad(a, a + 2, b + 2, b);
    quad(a + 1, b + 1, b + 3, a + 3);
  }
  const std::uint32_t end = 4 * static_cast<std::uint32_t>(blocks);
  quad(0, 1, 3, 2);
  quad(end, end + 2, end + 3, end + 1);
  return mesh;
}

/// Faces of a solid that touch have its material behind them, however long; a wall without thickness has none.
TEST(Pinches, FacesThatTouchAreNoWallWithoutThickness) {
  for (const int blocks : {6, 7, 24})
    for (const double gap : {0.0, -0.3}) {
      Mesh mesh = cut_ring(blocks, gap);
      ASSERT_GT(signed_volume(mesh), 0);
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
      for (Eigen::Vector3d& v : mesh.vertices) v = turn * v;
      auto solids = split_into_solids(mesh);
      ASSERT_EQ(solids.size(), 1u);
      solids[0].measure_thickness(0.5);  // no wall of it is thinner
      for (const double thickness : solids[0].thickness) EXPECT_GT(thickness, 0.5) << blocks << " blocks, gap " << gap;
    }
  Mesh flat = cut_ring(24, -0.3);
  for (Eigen::Vector3d& v : flat.vertices) v.z() = 0;
  auto solids = split_into_solids(flat);
  ASSERT_FALSE(solids.empty());
  double least = 1;
  for (geometry::Solid& solid : solids) {
    solid.measure_thickness(0.9);
    for (const double thickness : solid.thickness) least = std::min(least, thickness);
  }
  EXPECT_LT(least, 1e-12);
}

}  // namespace
}  // namespace dismantle::geometry
