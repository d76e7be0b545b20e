#include "dismantle/geometry/box_index.h"

#include <gtest/gtest.h>

#include <random>

namespace dismantle::geometry {
namespace {

std::vector<Aabb> some_boxes(std::size_t count, double room, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> at(0, room), size(0.1, 1);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d lo(at(rng), at(rng), at(rng));
    boxes.push_back({lo, lo + Eigen::Vector3d(size(rng), size(rng), size(rng))});
  }
  return boxes;
}

TEST(BoxIndex, FindsWhatAComparisonOfEachFinds) {
  for (const std::size_t count : {0u, 1u, 3u, 5u, 64u, 700u}) {
    std::vector<Aabb> boxes = some_boxes(count, 5, static_cast<unsigned>(count));
    if (count > 3) boxes[2] = Aabb{};                   // empty
    if (count > 5) boxes[4] = boxes[5] = boxes.back();  // at the same place
    const BoxIndex index(boxes);
    for (const Aabb& asked : some_boxes(50, 5, 7)) {
      std::vector<std::size_t> expected;
      for (std::size_t i = 0; i < count; ++i)
        if (boxes[i].overlaps(asked)) expected.push_back(i);
      EXPECT_EQ(index.overlapping(asked), expected) << count;
    }
  }
}

TEST(BoxIndex, TouchingBoxesOverlap) {
  const BoxIndex index({{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}});
  EXPECT_EQ(index.overlapping({{1, 1, 1}, {2, 2, 2}}), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(index.overlapping(Aabb{}).empty());
}

/// At the same density, eight times as many boxes take a few comparisons more, not eight times as many.
TEST(BoxIndex, WorkOfAQuestionDoesNotGrowWithTheNumberOfBoxes) {
  const auto work = [](std::size_t count, double room) {
    const BoxIndex index(some_boxes(count, room, 3));
    std::uint64_t compared = 0;
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(room / 2);
    index.overlapping({middle, middle + Eigen::Vector3d::Constant(1)}, &compared);
    return static_cast<double>(compared);
  };
  EXPECT_LT(work(64000, 40), 3 * work(1000, 10));
}

}  // namespace
}  // namespace dismantle::geometry
