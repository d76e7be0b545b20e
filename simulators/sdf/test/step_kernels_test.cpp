/// Batched computations of a step agree with single ones.
#include <gtest/gtest.h>

#include "dismantle/sdf/closest_on_triangle.h"
#include "dismantle/sdf/row_columns.h"
#include "dismantle/sdf/triangle_slabs.h"
#include "test_solids.h"

namespace dismantle::sdf {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(Rng& rng, double size) {
  return size * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
}

TEST(TriangleSlabs, BoundTheDistanceOfAnyTriangleAndMissLittleOfIt) {
  constexpr double kReach = 12;
  Rng rng(5);
  double missed = 0, measured = 0;
  for (int i = 0; i < 20'000; ++i) {
    // Lengths from 1e-4 to 10; every third one a sliver, every seventh without area, every 31st a point.
    const double size = std::pow(10.0, rng.uniform(-4, 1));
    const Vector3d a = random_vector(rng, 1), ab = random_vector(rng, size / 2);
    Vector3d ac = random_vector(rng, size / 2);
    if (i % 3 == 0) ac = rng.uniform(-1, 1) * ab + 1e-3 * ac;
    if (i % 7 == 0) ac = rng.uniform(-1, 1) * ab;
    const bool point = i % 31 == 0;
    const Vector3d u = point ? Vector3d::Zero() : ab, v = point ? Vector3d::Zero() : ac;
    const TriangleSlabs slabs(a, u, v, kReach);
    const Vector3d p = a + rng.uniform(0, 1) * u + rng.uniform(0, 1) * v + random_vector(rng, rng.uniform(0, 0.2));
    const double exact = closest(p, a, u, v).squared, bound = slabs.squared_distance(PointLanes(p));
    ASSERT_LE(bound, TriangleSlabs::filter(exact)) << "triangle " << i;
    missed += std::sqrt(exact) - std::sqrt(bound);
    measured += std::sqrt(exact);
  }
  EXPECT_LT(missed, 0.1 * measured);
}

TEST(RowColumns, GapsAreThoseOfTheRowsToTheLastBitAndTheLargestAlternativeHolds) {
  Rng rng(6);
  RowColumns columns;
  for (int round = 0; round < 50; ++round) {
    std::vector<ContactRow> rows;
    const std::size_t contacts = rng.below(40);
    for (std::size_t i = 0; i < contacts; ++i) {
      const int alternatives = static_cast<int>(rng.below(4));
      for (int k = 0; k <= alternatives; ++k) {
        ContactRow row;
        row.gap = rng.uniform(-0.01, 0.01);
        row.alternatives = k == 0 ? alternatives : 0;
        (rng.below(2) == 0 ? row.first : row.second) = 0;
        for (int d = 0; d < 6; ++d) row.j_first[d] = row.j_second[d] = rng.uniform(-1, 1);
        rows.push_back(row);
      }
    }
    Eigen::Matrix<double, 6, 1> x;
    for (int d = 0; d < 6; ++d) x[d] = rng.uniform(-0.01, 0.01);
    columns.assign<6>(rows);
    for (const bool tried : {false, true}) {
      const Eigen::Matrix<double, 6, 1> at = tried ? x : Eigen::Matrix<double, 6, 1>::Zero();
      if (tried) columns.try_at<6>(x, 6);
      std::vector<double> held, expected;
      columns.for_each_held(tried, [&](const ContactRow& row, double gap) {
        EXPECT_EQ(gap, row.gap_at(at, 6));
        held.push_back(gap);
      });
      for (std::size_t i = 0; i < rows.size(); i += 1 + static_cast<std::size_t>(rows[i].alternatives)) {
        double gap = rows[i].gap_at(at, 6);
        for (int k = 1; k <= rows[i].alternatives; ++k)
          gap = std::max(gap, rows[i + static_cast<std::size_t>(k)].gap_at(at, 6));
        if (gap < 0) expected.push_back(gap);
      }
      ASSERT_EQ(held, expected);
    }
  }
}

}  // namespace
}  // namespace dismantle::sdf
