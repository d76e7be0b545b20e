// Laws of the layout: nothing overlaps, large boxes are placed first and nearest, the same boxes give the same layout.
#include "dismantle/engine/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

Aabb random_box(Rng& rng, double most) {
  Aabb box;
  const Vector3d at(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-5, 5));
  box.extend(at);
  box.extend(at + Vector3d(rng.uniform(0.01, most), rng.uniform(0.01, most), rng.uniform(0.01, most)));
  return box;
}

Aabb shifted(Aabb box, const Vector3d& displacement) {
  box.lo += displacement;
  box.hi += displacement;
  return box;
}

/// Distance between the projections of two boxes on the plane, along its axes.
double apart(const Aabb& a, const Aabb& b, int up) {
  double most = -1e300;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != up) most = std::max({most, b.lo[axis] - a.hi[axis], a.lo[axis] - b.hi[axis]});
  return most;
}

TEST(Layout, NothingOverlapsAndAllLiesOnThePlane) {
  Rng rng(1);
  for (int trial = 0; trial < 60; ++trial) {
    const int up = static_cast<int>(rng.below(3));
    const double sign = rng.below(2) == 0 ? 1 : -1;
    const Eigen::Vector3d tilt(rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4));
    const Eigen::Vector3d nearly = (sign * Eigen::Vector3d::Unit(up) + tilt).normalized();
    const double gap = rng.uniform(0.01, 2);
    std::vector<Aabb> taken{random_box(rng, 10)}, boxes;
    for (auto n = rng.below(3); n > 0; --n) taken.push_back(random_box(rng, 8));
    for (auto n = 1 + rng.below(30); n > 0; --n) boxes.push_back(random_box(rng, 6));
    const auto shifts = lay_out(boxes, taken, nearly, gap);
    ASSERT_EQ(shifts.size(), boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Aabb a = shifted(boxes[i], shifts[i]);
      EXPECT_NEAR(sign > 0 ? a.lo[up] : a.hi[up], sign > 0 ? taken[0].lo[up] : taken[0].hi[up], 1e-12);
      for (const auto& t : taken) EXPECT_GE(apart(a, t, up), gap);
      for (std::size_t k = 0; k < i; ++k) EXPECT_GE(apart(a, shifted(boxes[k], shifts[k]), up), gap);
    }
  }
}

/// Many boxes of few sizes, which fill the plane around the middle: each lies where no free place is nearer, as a
/// search of all corners finds it.
TEST(Layout, EachBoxIsAsNearAsItCanBe) {
  Rng rng(3);
  for (int trial = 0; trial < 6; ++trial) {
    const double gap = rng.uniform(0.05, 0.5);
    std::vector<Vector3d> sizes;
    for (int k = 0; k < 4; ++k) sizes.emplace_back(rng.uniform(0.2, 2), rng.uniform(0.2, 2), 1);
    const std::vector<Aabb> taken{random_box(rng, 6)};
    std::vector<Aabb> boxes;
    for (int k = 0; k < 120; ++k) {
      Aabb box;
      box.extend(Vector3d(rng.uniform(-5, 5), rng.uniform(-5, 5), 0));
      box.extend(box.lo + (rng.below(3) == 0 ? sizes[0] : sizes[rng.below(4)]));
      boxes.push_back(box);
    }
    const auto shifts = lay_out(boxes, taken, Vector3d::UnitZ(), gap);
    std::vector<std::size_t> order(boxes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return boxes[a].size().head<2>().prod() > boxes[b].size().head<2>().prod();
    });
    std::vector<Aabb> there = taken;
    const Vector3d middle = taken[0].center();
    for (const std::size_t i : order) {
      const Vector3d size = boxes[i].size(), wish = middle - size / 2;
      std::vector<double> xs{wish.x()}, ys{wish.y()};
      for (const Aabb& t : there)
        for (const double side : {-1.0, 1.0}) {
          const double far = gap * (1 + 1e-8);
          xs.push_back(side < 0 ? t.lo.x() - far - size.x() : t.hi.x() + far);
          ys.push_back(side < 0 ? t.lo.y() - far - size.y() : t.hi.y() + far);
        }
      double least = std::numeric_limits<double>::infinity();
      for (const double x : xs)
        for (const double y : ys) {
          const double distance = (Eigen::Vector2d(x, y) - wish.head<2>()).norm();
          if (distance >= least) continue;
          const bool is_free = std::none_of(there.begin(), there.end(), [&](const Aabb& t) {
            return x > t.lo.x() - gap - size.x() && x < t.hi.x() + gap && y > t.lo.y() - gap - size.y() &&
                   y < t.hi.y() + gap;
          });
          if (is_free) least = distance;
        }
      there.push_back(shifted(boxes[i], shifts[i]));
      EXPECT_LE((there.back().lo - wish).head<2>().norm(), least + 1e-6) << trial << " " << i;
    }
  }
}

TEST(Layout, SameBoxesSameLayout) {
  Rng rng(2);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 40; ++i) boxes.push_back(random_box(rng, 5));
  const std::vector<Aabb> taken{random_box(rng, 10)};
  EXPECT_EQ(lay_out(boxes, taken, Eigen::Vector3d::UnitZ(), 0.5), lay_out(boxes, taken, Eigen::Vector3d::UnitZ(), 0.5));
}

TEST(Layout, OfEqualShapesTheLargerLieNearer) {
  Aabb base;
  base.extend(Vector3d(-5, -5, 0));
  base.extend(Vector3d(5, 5, 4));
  std::vector<Aabb> boxes;
  for (int i = 0; i < 12; ++i) {
    boxes.emplace_back();
    boxes.back().extend(Vector3d(0, 0, 0));
    boxes.back().extend(Vector3d::Constant(0.5 + 0.5 * ((7 * i) % 12)));
  }
  const auto shifts = lay_out(boxes, {base}, Eigen::Vector3d::UnitZ(), 0.5);
  // The position of a box does not depend on smaller ones: leaving small boxes out changes nothing.
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return boxes[a].size().x() > boxes[b].size().x(); });
  std::vector<Aabb> some;
  for (std::size_t k = 0; k < order.size(); ++k) {
    some.push_back(boxes[order[k]]);
    const auto fewer = lay_out(some, {base}, Eigen::Vector3d::UnitZ(), 0.5);
    for (std::size_t j = 0; j <= k; ++j) EXPECT_EQ(fewer[j], shifts[order[j]]);
  }
  // The largest four find a place at the four sides, right beside the base.
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(apart(shifted(boxes[order[k]], shifts[order[k]]), base, 2), 0.5, 1e-6);
}

/// Law: each box lies at the free position nearest to the centre of the box it lies around; brute force over all edges
/// in both coordinates.
TEST(Layout, EachLiesAtTheNearestFreePlace) {
  Rng rng(3);
  constexpr double kGap = 0.3, kRounding = 1e-6;
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<Aabb> boxes, taken{random_box(rng, 8)};
    const bool equal = trial % 2 == 0;  // many ties, as of equal washers
    const Aabb model = random_box(rng, 3);
    for (int n = 0; n < 25; ++n) boxes.push_back(equal ? model : random_box(rng, 3));
    const auto shifts = lay_out(boxes, taken, Eigen::Vector3d::UnitZ(), kGap);
    std::vector<std::size_t> order(boxes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return boxes[a].size().head<2>().prod() > boxes[b].size().head<2>().prod();
    });
    const Eigen::Vector2d middle = taken.front().center().head<2>();
    for (const std::size_t i : order) {
      const Eigen::Vector2d size = boxes[i].size().head<2>();
      const auto corner_of = [&](const Eigen::Vector2d& center) { return Eigen::Vector2d(center - size / 2); };
      const auto nearest = [&](double gap) {
        std::vector<double> xs{corner_of(middle).x()}, ys{corner_of(middle).y()};
        for (const Aabb& t : taken) {
          xs.insert(xs.end(), {t.hi.x() + gap, t.lo.x() - gap - size.x()});
          ys.insert(ys.end(), {t.hi.y() + gap, t.lo.y() - gap - size.y()});
        }
        double least = 1e300;
        for (const double x : xs)
          for (const double y : ys) {
            const Eigen::Array2d corner(x, y);
            if (std::none_of(taken.begin(), taken.end(), [&](const Aabb& t) {
                  return (corner < t.hi.head<2>().array() + gap - kRounding / 10 &&
                          corner + size.array() > t.lo.head<2>().array() - gap + kRounding / 10)
                      .all();
                }))
              least = std::min(least, (corner.matrix() - corner_of(middle)).norm());
          }
        return least;
      };
      const Aabb placed = shifted(boxes[i], shifts[i]);
      // Rounding decides whether a box fits between two that are exactly one box apart.
      const double distance = (placed.lo.head<2>() - corner_of(middle)).norm();
      EXPECT_GE(distance, nearest(kGap) - kRounding);
      EXPECT_LE(distance, nearest(kGap + kRounding) + 10 * kRounding);
      taken.push_back(placed);
    }
  }
}

TEST(Layout, WantsSomethingToLieAround) {
  EXPECT_THROW(lay_out({}, {}, Eigen::Vector3d::UnitZ(), 1), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle
