// Intervals and curves against values worked out by hand or taken from tables; the columns of a trial.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "dismantle/bench/report.h"

namespace dismantle::bench {
namespace {

TEST(Wilson, KnownValues) {
  // Newcombe (1998), table I: 81/263 and 15/148 by the score method.
  EXPECT_NEAR(wilson(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson(15, 148).high, 0.1605, 5e-5);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson(29, 29).low, 0.8830, 5e-5);
}

TEST(Wilson, StaysInRangeAndIsSymmetric) {
  for (std::size_t n : {1u, 2u, 7u, 100u})
    for (std::size_t k = 0; k <= n; ++k) {
      const Proportion p = wilson(k, n), q = wilson(n - k, n);
      EXPECT_LE(0, p.low);
      EXPECT_LE(p.low, p.share);
      EXPECT_LE(p.share, p.high);
      EXPECT_LE(p.high, 1);
      EXPECT_NEAR(p.low, 1 - q.high, 1e-12);
    }
}

TEST(SuccessOverTime, WithoutCensoringItIsTheShare) {
  const auto steps = success_over_time({{1, true}, {2, true}, {2, true}}, 1);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_DOUBLE_EQ(steps[0].second, 0.25);
  EXPECT_DOUBLE_EQ(steps[1].second, 0.75);
}

TEST(SuccessOverTime, CensoredTrialsLeaveTheRest) {
  // Of 4, one is solved at 1, one is censored at 2, one is solved at 3 when two are left.
  const auto steps = success_over_time({{3, true}, {2, false}, {1, true}, {4, false}}, 0);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_DOUBLE_EQ(steps[0].second, 0.25);
  EXPECT_DOUBLE_EQ(steps[1].second, 1 - 0.75 * 0.5);
}

TEST(SuccessOverTime, SolvedBeforeCensoredAtTheSameTime) {
  const auto steps = success_over_time({{5, false}, {5, true}}, 0);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_DOUBLE_EQ(steps[0].second, 0.5);
}

TEST(TrialColumns, EachIsInTheDocs) {
  std::ifstream in(CONFIGS_FOLDER "/../docs/benchmark.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  std::set<std::string> names;
  for_columns(ReportRow{}, [&]<class T>(const std::string& name, const T&, const std::string& doc) {
    EXPECT_TRUE(names.insert(name).second) << name;
    const char* type = "0 or 1";
    if (std::is_same_v<T, std::string>) type = "text";
    if (std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::optional<std::int64_t>>) type = "integer";
    if (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>) type = "number";
    const std::string line = "| `" + name + "` | " + type + " | " + doc + " |\n";
    EXPECT_NE(page.find(line), std::string::npos) << "missing in docs/benchmark.md: " << line;
  });
}

TEST(SuccessOverTime, NothingSolved) { EXPECT_TRUE(success_over_time({{5, false}}, 3).empty()); }

}  // namespace
}  // namespace dismantle::bench
