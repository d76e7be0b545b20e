// Triangles that are proved clear along many turns of a screw do not meet the other mesh; runs of cells hold what was
// added.
#include "dismantle/geometry/unrolled_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using Eigen::Vector3d;

/// Against one set per cell.
TEST(RowRuns, HoldWhatWasAdded) {
  Rng rng(31);
  constexpr std::int32_t kColumns = 40;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t rows = 1 + rng.below(4);
    RowRuns runs(rows);
    std::vector<std::array<RowRuns::Bits, kColumns>> cells(rows, std::array<RowRuns::Bits, kColumns>{});
    for (std::size_t n = rng.below(30); n > 0; --n) {
      const std::size_t row = rng.below(rows);
      const auto first = static_cast<std::int32_t>(rng.below(kColumns));
      const auto last = static_cast<std::int32_t>(first + rng.below(kColumns - static_cast<std::size_t>(first)));
      RowRuns::Bits bits{};
      for (std::size_t k = 1 + rng.below(3); k > 0; --k) bits[rng.below(2)] |= 1ULL << (16 * rng.below(4));
      runs.add(row, first, last, bits);
      for (std::int32_t c = first; c <= last; ++c)
        for (std::size_t word = 0; word < 2; ++word) cells[row][static_cast<std::size_t>(c)][word] |= bits[word];
    }
    runs.finish();
    for (std::size_t row = 0; row < rows; ++row)
      for (std::int32_t first = 0; first < kColumns; ++first)
        for (std::int32_t last = first; last < kColumns; ++last) {
          RowRuns::Bits expected{}, found{};
          for (std::int32_t c = first; c <= last; ++c)
            for (std::size_t word = 0; word < 2; ++word)
              expected[word] |= cells[row][static_cast<std::size_t>(c)][word];
          EXPECT_TRUE(runs.each(row, first, last, [&](const RowRuns::Bits& bits) {
            for (std::size_t word = 0; word < 2; ++word) found[word] |= bits[word];
            return true;
          }));
          ASSERT_EQ(found, expected) << row << ' ' << first << ' ' << last;
        }
  }
}

/// Three turns about z, rising.
RelativeMotion turns(double pitch, std::size_t segments) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k <= segments; ++k) {
    const double angle = 6 * M_PI * static_cast<double>(k) / static_cast<double>(segments);
    poses.push_back({{0, 0, pitch * angle}, rotation_from_vector({0, 0, angle})});
  }
  Aabb box;
  box.extend(Vector3d(-4, -4, -4));
  box.extend(Vector3d(4, 4, 4));
  return {poses, {Pose{}}, box};
}

struct Sides {
  bool inside = false, outside = false;
};

/// On which sides of a mesh sampled points of a triangle are while it moves from instant `begin` to `end`.
Sides sampled(const TriangleBvh& mesh, const RelativeMotion& motion, const Corners& t, std::size_t begin,
              std::size_t end, int times) {
  constexpr int kGrid = 4;
  Sides seen;
  for (int k = 0; k <= times && !(seen.inside && seen.outside); ++k) {
    const Pose at = motion.at(static_cast<double>(begin) + static_cast<double>(end - begin) * k / times);
    for (int i = 0; i <= kGrid; ++i)
      for (int j = 0; i + j <= kGrid; ++j) {
        const Vector3d p = t[0] + (i * (t[1] - t[0]) + j * (t[2] - t[0])) / kGrid;
        (mesh.inside(at * p) ? seen.inside : seen.outside) = true;
      }
  }
  return seen;
}

/// A small triangle around a point.
Corners triangle_at(const Vector3d& middle, Rng& rng) {
  Corners t;
  for (Vector3d& corner : t) corner = middle + 0.1 * Vector3d(rng.normal(), rng.normal(), rng.normal());
  return t;
}

/// A small block in the way of small triangles at about the same distance from the axis. Of those that are proved to
/// pass it, no sampled point is ever in it; of those that hit it by sampling, none is proved. Most that pass are
/// proved.
TEST(UnrolledMesh, WhatIsProvedToPassDoesNotHit) {
  Rng rng(32);
  int hit = 0, passed = 0, proved = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const double pitch = (rng.below(2) == 0 ? 1 : -1) * (0.05 + 0.3 * rng.uniform());
    const RelativeMotion motion = turns(pitch, 40);
    const std::vector<Winding> all = windings(motion, 1e-6);
    ASSERT_EQ(all.size(), 1u);
    const Winding& w = all.front();
    const double radius = 1 + rng.uniform(), angle = 2 * M_PI * rng.uniform();
    const Vector3d place(radius * std::cos(angle), radius * std::sin(angle), pitch * 6 * M_PI * rng.uniform());
    const Vector3d half = (0.02 + 0.1 * rng.uniform()) * Vector3d::Ones();
    const TriangleBvh block(shapes::box(place - half, place + half));
    const double start = 2 * M_PI * rng.uniform();
    const Vector3d middle(radius * std::cos(start), radius * std::sin(start), 0.3 * rng.normal());
    const Corners t = triangle_at(middle, rng);
    const UnrolledMesh mesh(block, w, {&t, 1}, w.begin, w.end, 0.002);
    std::uint64_t work = 0;
    const bool clear = mesh.clear_of(t, w.begin, w.end, work);
    const bool inside = sampled(block, motion, t, w.begin, w.end, 4000).inside;
    hit += inside;
    passed += !inside;
    proved += clear;
    ASSERT_FALSE(clear && inside) << trial;
  }
  EXPECT_GT(hit, 60);
  EXPECT_GT(proved, passed * 8 / 10) << passed;
}

/// A mesh holds only what the triangles that are asked about sweep between two instants: of many triangles asked at the
/// same time, none that hits a wide ring there is proved to pass it, and most of those that pass are proved.
TEST(UnrolledMesh, HoldsWhatAnyOfTheTrianglesAskedMayMeet) {
  Rng rng(33);
  int hit = 0, passed = 0, proved = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double pitch = (rng.below(2) == 0 ? 1 : -1) * (0.02 + 0.2 * rng.uniform());
    const RelativeMotion motion = turns(pitch, 60);
    const std::vector<Winding> all = windings(motion, 1e-6);
    ASSERT_EQ(all.size(), 1u);
    const Winding& w = all.front();
    const double low = pitch * 6 * M_PI * rng.uniform() - 0.2;
    const Mesh ring = shapes::tube(1.2, 1.8, low, low + 0.1 + 0.3 * rng.uniform(), 24, 3);
    const Pose turned{{0, 0, 0}, rotation_from_vector({0, 0, rng.uniform(0, 6)})};
    const TriangleBvh bvh(shapes::moved(ring, turned));
    std::vector<Corners> asked(1 + rng.below(rng.below(2) == 0 ? 2 : 20));
    for (Corners& t : asked) {
      const double radius = rng.uniform(0.8, 2.2), angle = rng.uniform(0, 6);
      t = triangle_at({radius * std::cos(angle), radius * std::sin(angle), rng.uniform(-1, 1)}, rng);
    }
    const std::size_t from = rng.below(40), to = from + 2 + rng.below(59 - from);
    const UnrolledMesh mesh(bvh, w, asked, from, to, 0.004);
    for (const Corners& t : asked) {
      std::uint64_t work = 0;
      const std::size_t begin = from + rng.below(to - from), end = rng.below(2) == 0 ? to : begin + 1;
      const bool clear = mesh.clear_of(t, begin, end, work);
      const Sides seen = sampled(bvh, motion, t, begin, end, 600);
      const bool meets = seen.inside && seen.outside;  // it goes through the surface
      hit += meets;
      passed += !meets;
      proved += clear;
      ASSERT_FALSE(clear && meets) << trial;
    }
  }
  EXPECT_GT(hit, 100);
  EXPECT_GT(proved, passed * 8 / 10) << passed;
}

}  // namespace
}  // namespace dismantle::geometry
