// Results of checks that are found again.
#include "pair_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Memory = PairMemory<int>;

std::vector<Pose> random_path(Rng& rng, std::size_t count) {
  std::vector<Pose> path(count);
  for (Pose& p : path) p.t = {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
  return path;
}

/// What was added is found by exactly its key: a difference in the last bit of a pose, the rung or the order of the pair
/// is another question.
TEST(PairMemory, FindsExactlyTheSameCheck) {
  Rng rng(7);
  Memory memory;
  for (int k = 0; k < 100; ++k) {
    const auto a = static_cast<PartId>(rng.below(4)), b = static_cast<PartId>(4 + rng.below(4));
    const std::vector<Pose> moving = random_path(rng, 2 + rng.below(5)), fixed = random_path(rng, 1);
    const std::size_t rung = rng.below(3);
    EXPECT_EQ(memory.find({a, b, rung, &moving, &fixed}), std::nullopt);
    memory.add({a, b, rung, &moving, &fixed}, k);
    EXPECT_EQ(memory.find({a, b, rung, &moving, &fixed}), k);
    EXPECT_EQ(memory.find({b, a, rung, &moving, &fixed}), std::nullopt);
    EXPECT_EQ(memory.find({a, b, rung + 3, &moving, &fixed}), std::nullopt);
    std::vector<Pose> other = moving;
    double& x = other[rng.below(other.size())].t.y();
    x = std::nextafter(x, 2.0);
    EXPECT_EQ(memory.find({a, b, rung, &other, &fixed}), std::nullopt);
    other = moving;
    other.pop_back();
    EXPECT_EQ(memory.find({a, b, rung, &other, &fixed}), std::nullopt);
  }
}

/// Its size is bounded: old results are forgotten, new ones are there.
TEST(PairMemory, ForgetsWhenItIsFull) {
  Rng rng(8);
  Memory memory;
  const std::vector<Pose> fixed(1), first = random_path(rng, 3);
  memory.add({0, 1, 0, &first, &fixed}, -1);
  bool forgotten = false;
  for (int k = 0; k < 1000; ++k) {
    const std::vector<Pose> path = random_path(rng, 3);
    memory.add({0, 1, 0, &path, &fixed}, k);
    EXPECT_EQ(memory.find({0, 1, 0, &path, &fixed}), k);
    forgotten = forgotten || !memory.find({0, 1, 0, &first, &fixed});
  }
  EXPECT_TRUE(forgotten);
}

}  // namespace
}  // namespace dismantle
