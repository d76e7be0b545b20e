// Laws of the edit distance: it is a metric (up to swaps); and which words count as near.
#include "dismantle/host/suggest.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

std::string random_word(Rng& rng) {
  std::string word;
  for (std::uint64_t n = rng.below(8); n > 0; --n) word += static_cast<char>('a' + rng.below(3));
  return word;
}

TEST(EditDistance, KnownPairs) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("goal_bais", "goal_bias"), 1u);  // neighbours swapped
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(EditDistance, ZeroOnlyForEqualAndSymmetric) {
  Rng rng(3);
  for (int i = 0; i < 3000; ++i) {
    const std::string a = random_word(rng), b = random_word(rng);
    EXPECT_EQ(edit_distance(a, b) == 0, a == b);
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
    EXPECT_LE(edit_distance(a, b), std::max(a.size(), b.size()));
  }
}

TEST(EditDistance, OneEditIsOneApart) {
  Rng rng(4);
  for (int i = 0; i < 1000; ++i) {
    std::string a = random_word(rng) + "x", b = a;
    const std::size_t at = rng.below(b.size());
    switch (rng.below(3)) {
      case 0:
        b[at] = 'z';
        break;
      case 1:
        b.erase(at, 1);
        break;
      default:
        b.insert(at, 1, 'z');
    }
    EXPECT_EQ(edit_distance(a, b), 1u) << a << " " << b;
  }
}

TEST(Nearest, OnlyWhatIsNear) {
  EXPECT_EQ(nearest("goal_bais", {"range", "goal_bias"}), "goal_bias");
  EXPECT_EQ(nearest("bsf", {"rrt", "bfs"}), "bfs");
  EXPECT_EQ(nearest("x", {"y", "zz"}), "y");
  EXPECT_EQ(nearest("speed", {"depth", "motion"}), std::nullopt);
  EXPECT_EQ(nearest("abc", {}), std::nullopt);
  EXPECT_EQ(nearest("seat", {"seet", "seaa"}), "seet");  // the first of equals
}

}  // namespace
}  // namespace dismantle
