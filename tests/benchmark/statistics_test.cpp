// Intervals and curves against values worked out by hand or taken from tables; the columns of a trial.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "dismantle/bench/report.h"
#include "dismantle/bench/statistics.h"

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
      const Proportion p = wilson(double(k), double(n)), q = wilson(double(n - k), double(n));
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

TEST(SignTest, KnownValues) {
  EXPECT_DOUBLE_EQ(sign_test(0, 0), 1);
  EXPECT_DOUBLE_EQ(sign_test(3, 3), 1);
  EXPECT_NEAR(sign_test(5, 0), 2.0 / 32, 1e-12);                // closed form
  EXPECT_NEAR(sign_test(1, 8), 2 * (1 + 9) / 512.0, 1e-12);     // closed form
  EXPECT_NEAR(sign_test(10, 2), 2 * 79 / 4096.0, 1e-12);        // 1 + 12 + 66
  EXPECT_NEAR(sign_test(2, 10), sign_test(10, 2), 1e-12);
}

TEST(Wilcoxon, KnownValues) {
  // All of one sign: 2 of the 2^n signs are as extreme.
  const SignedRanks all = wilcoxon({1, 2, 3, 4, 5, 6});
  EXPECT_NEAR(all.p, 2.0 / 64, 1e-12);
  EXPECT_DOUBLE_EQ(all.effect, 1);
  // Critical values of tables, two-sided 0.05: n = 10: 8, n = 15: 25, n = 20: 52. Signs that give such a sum of ranks.
  const auto p_of = [](std::size_t n, std::vector<int> negative) {
    std::vector<double> d;
    for (std::size_t i = 1; i <= n; ++i) d.push_back(double(i));
    for (const int rank : negative) d[std::size_t(rank) - 1] *= -1;
    return wilcoxon(d).p;
  };
  EXPECT_NEAR(p_of(10, {8}), 0.048828125, 1e-12);  // 25 of 1024 subsets have a sum of at most 8
  EXPECT_GT(p_of(10, {9}), 0.05);
  EXPECT_LE(p_of(15, {10, 15}), 0.05);
  EXPECT_GT(p_of(15, {11, 15}), 0.05);
  EXPECT_LE(p_of(20, {20, 19, 13}), 0.05);
  EXPECT_GT(p_of(20, {20, 19, 14}), 0.05);
}

TEST(Wilcoxon, TiesAndZeros) {
  // 0 is left out; |1| three times has the rank 2 each; 2 has 4. Sum of negative ranks 2: of the 16 signs, the empty
  // set, three single 2s and their mirrors are as extreme: 8.
  const SignedRanks r = wilcoxon({0, 1, -1, 1, 2});
  EXPECT_EQ(r.n, 4u);
  EXPECT_DOUBLE_EQ(r.plus, 8);
  EXPECT_DOUBLE_EQ(r.minus, 2);
  EXPECT_NEAR(r.p, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(r.effect, 0.6);
  EXPECT_DOUBLE_EQ(wilcoxon({0, 0}).p, 1);
}

TEST(Wilcoxon, LargeSamplesAgreeWithTheClosedForm) {
  // Above 50: mean n (n + 1) / 4, variance n (n + 1) (2 n + 1) / 24.
  std::vector<double> d;
  for (int i = 1; i <= 60; ++i) d.push_back(i % 3 == 0 ? -i : i);
  const SignedRanks r = wilcoxon(d);
  const double z = (std::abs(r.plus - 60 * 61 / 4.0) - 0.5) / std::sqrt(60.0 * 61 * 121 / 24);
  EXPECT_NEAR(r.p, std::erfc(z / std::sqrt(2.0)), 1e-12);
  // The exact test of 50 and the approximation of 51 do not differ by much.
  d.resize(50);
  const double exact = wilcoxon(d).p;
  d.push_back(1e-9);  // the smallest: its sign hardly matters
  EXPECT_NEAR(exact, wilcoxon(d).p, 0.01);
}

TEST(TimeToSolution, QuantilesAndRestrictedMean) {
  const SuccessSteps steps = success_over_time({{1, true}, {2, true}, {4, true}}, 1);
  EXPECT_EQ(time_to(steps, 0.25), 1);
  EXPECT_EQ(time_to(steps, 0.5), 2);
  EXPECT_EQ(time_to(steps, 0.75), 4);
  EXPECT_FALSE(time_to(steps, 0.76));
  EXPECT_NEAR(restricted_mean(steps, 10), (1 + 2 + 4 + 10) / 4.0, 1e-12);  // without censoring: the mean of the minima
  EXPECT_NEAR(restricted_mean(steps, 3), (1 + 2 + 3 + 3) / 4.0, 1e-12);
  EXPECT_NEAR(restricted_mean({}, 7), 7, 1e-12);
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
