#include "dismantle/run_context.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "dismantle/outcome.h"

namespace dismantle {
namespace {

TEST(Deadline, NeverPassesUnlessSet) {
  const Deadline never;
  EXPECT_FALSE(never.passed());
  EXPECT_EQ(never.seconds_left(), std::numeric_limits<double>::infinity());
  for (const double s : {std::numeric_limits<double>::infinity(), 1e300, std::nan("")})
    EXPECT_EQ(Deadline::after_seconds(s).seconds_left(), std::numeric_limits<double>::infinity());
}

TEST(Deadline, ZeroAndLessIsNow) {
  EXPECT_TRUE(Deadline::after_seconds(0).passed());
  EXPECT_TRUE(Deadline::after_seconds(-5).passed());
  EXPECT_LE(Deadline::after_seconds(0).seconds_left(), 0);
}

TEST(Deadline, EarlierOfTwo) {
  const Deadline never;
  const Deadline now = Deadline::after_seconds(0);
  EXPECT_TRUE(never.earlier(now).passed());
  EXPECT_TRUE(now.earlier(never).passed());
  EXPECT_FALSE(never.earlier(never).passed());
}

TEST(CancelToken, CopiesShareTheFlag) {
  RunContext context;
  const RunContext copy = context;
  EXPECT_FALSE(copy.should_stop());
  context.cancel.cancel();
  EXPECT_TRUE(copy.should_stop());
}

TEST(Rng, FirstNumbersAreTheSameOnEveryMachine) {
  Rng rng(0);  // published reference output of xoshiro256** seeded by SplitMix64(0)
  EXPECT_EQ(rng.next(), 0x99ec5f36cb75f2b4ull);
  EXPECT_EQ(rng.next(), 0xbf6e1f784956452aull);
}

TEST(Rng, UniformIsInRangeAndEven) {
  Rng rng(3);
  std::vector<int> bins(10, 0);
  for (int i = 0; i < 100000; ++i) {
    const double x = rng.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    ++bins[static_cast<std::size_t>(x * 10)];
  }
  for (const int n : bins) EXPECT_NEAR(n, 10000, 500);
  for (int i = 0; i < 1000; ++i) {
    const double x = rng.uniform(1.0, std::nextafter(1.0, 2.0));
    EXPECT_EQ(x, 1.0);  // the upper bound is not in the range
  }
}

TEST(Rng, BelowReachesEveryValueAndNoOther) {
  Rng rng(4);
  for (const std::uint64_t n : {1ull, 2ull, 3ull, 7ull, 64ull}) {
    std::set<std::uint64_t> seen;
    for (int i = 0; i < 2000; ++i) {
      const std::uint64_t x = rng.below(n);
      ASSERT_LT(x, n);
      seen.insert(x);
    }
    EXPECT_EQ(seen.size(), n);
  }
  EXPECT_LT(rng.below(std::numeric_limits<std::uint64_t>::max()), std::numeric_limits<std::uint64_t>::max());
}

TEST(Rng, NormalHasMeanZeroAndVarianceOne) {
  Rng rng(5);
  double sum = 0, squares = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / n, 0, 0.02);
  EXPECT_NEAR(squares / n, 1, 0.03);
}

TEST(Rng, ForkDependsOnSeedAndStreamOnly) {
  Rng a(9);
  Rng b(9);
  b.next();
  b.uniform();
  EXPECT_EQ(a.fork(5).next(), b.fork(5).next());
  std::set<std::uint64_t> firsts;
  for (std::uint64_t seed = 0; seed < 30; ++seed)
    for (std::uint64_t stream = 0; stream < 30; ++stream) firsts.insert(Rng(seed).fork(stream).next());
  EXPECT_EQ(firsts.size(), 900u);
}

TEST(Outcome, NamesGoThereAndBack) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(Outcome::crashed); ++i) {
    const auto o = static_cast<Outcome>(i);
    EXPECT_EQ(outcome_from_string(to_string(o)), o);
    names.insert(to_string(o));
  }
  EXPECT_EQ(names.size(), 10u);
  EXPECT_FALSE(outcome_from_string("Solved").has_value());
  EXPECT_FALSE(outcome_from_string("").has_value());
}

}  // namespace
}  // namespace dismantle
