// Laws of turns, portions, shortcuts and candidates, on random cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "dismantle/search/candidates.h"
#include "dismantle/search/growing_turns.h"
#include "dismantle/search/shortcuts.h"
#include "dismantle/testing/path_checking.h"

namespace dismantle::path {
namespace {

/// By unit of work: the search that did it.
std::vector<std::size_t> order_of_work(std::size_t searches, std::uint64_t first, std::uint64_t total,
                                       const std::vector<std::uint64_t>& portions, std::uint64_t most_a_step, Rng rng) {
  GrowingTurns turns(searches, first);
  std::vector<std::size_t> order;
  const auto used = [&] { return std::uint64_t{order.size()}; };
  const auto grow = [&](std::size_t i, std::uint64_t until) {
    while (used() < until) order.insert(order.end(), 1 + rng.below(most_a_step), i);
    return false;
  };
  for (const std::uint64_t p : portions) EXPECT_FALSE(turns.run(end_of_portion(used(), p, total), used, grow));
  EXPECT_FALSE(turns.run(total, used, grow));
  return order;
}

TEST(GrowingTurns, RoundsDoubleAndPortionsChangeNothing) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Rng rng(seed);
    const std::size_t searches = 1 + rng.below(4);
    const std::uint64_t first = 1 + rng.below(20), total = 1 + rng.below(2000);
    std::vector<std::uint64_t> portions(rng.below(30));
    for (auto& p : portions) p = 1 + rng.below(100);
    const auto whole = order_of_work(searches, first, total, {}, 1, rng);
    EXPECT_EQ(order_of_work(searches, first, total, portions, 1, rng), whole) << seed;
    ASSERT_EQ(whole.size(), total);
    // In round r each search does first * 2^r units of work; the last search does the rest.
    std::uint64_t at = 0;
    for (std::uint64_t turn = first; searches > 1 && at < total; turn *= 2)
      for (std::size_t i = 0; i < searches; ++i)
        for (std::uint64_t k = 0; k < turn && at < total; ++k) ASSERT_EQ(whole[at++], i) << seed;
  }
}

TEST(GrowingTurns, StepsThatOvershootAreLawfulToo) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Rng rng(seed);
    const std::uint64_t total = 1 + rng.below(2000), most = 1 + rng.below(30);
    const auto order = order_of_work(2, 10, total, {}, most, rng);
    EXPECT_GE(order.size(), total);
    EXPECT_LT(order.size(), total + most);
  }
}

TEST(GrowingTurns, EndsWhenASearchSaysSo) {
  GrowingTurns turns(3, 5);
  std::uint64_t used = 0;
  EXPECT_TRUE(turns.run(
      1000, [&] { return used; }, [&](std::size_t, std::uint64_t) { return ++used > 7; }));
  EXPECT_EQ(used, 8u);
}

TEST(GrowingTurns, WorkOfADepthLimitDoubles) {
  EXPECT_EQ(doubled_per_level(500, 0), ~std::uint64_t{0});
  for (unsigned depth = 1; depth < 30; ++depth)
    EXPECT_EQ(doubled_per_level(500, depth), std::uint64_t{500} << (depth - 1));
  EXPECT_EQ(doubled_per_level(500, 200), ~std::uint64_t{0}) << "it never wraps";
}

/// Waypoints on a line, with direct motions between some pairs. The first and last waypoints remain, and every new
/// motion was checked.
TEST(Shortcuts, LeaveJoinedWaypointsInOrder) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const int n = 2 + static_cast<int>(rng.below(40));
    const double share = rng.uniform();
    std::vector<int> all(static_cast<std::size_t>(n));
    std::iota(all.begin(), all.end(), 0);
    const std::uint64_t salt = rng.next();
    const auto joined = [&](int a, int b) {
      return b - a == 1 || Rng(salt + static_cast<std::uint64_t>(a * 1000 + b)).uniform() < share;
    };
    std::vector<int> pieces = all, random = all;
    const auto never = [] { return false; };
    shortcut_pieces(pieces, joined, never);
    Rng draws = rng.fork(1);
    shortcut_at_random(
        random, 200, draws,
        [&](std::size_t a, std::size_t b, std::vector<int>&) { return joined(random[a], random[b]); }, never);
    for (const auto& left : {shortcut_by_halving(all, joined), pieces, random}) {
      ASSERT_EQ(left.front(), 0);
      ASSERT_EQ(left.back(), n - 1);
      for (std::size_t k = 1; k < left.size(); ++k) {
        ASSERT_LT(left[k - 1], left[k]);
        ASSERT_TRUE(joined(left[k - 1], left[k])) << seed;
      }
      if (share >= 1) {
        EXPECT_EQ(left.size(), 2u);
      }
    }
  }
}

TEST(Shortcuts, StopWhenToldTo) {
  std::vector<int> all(50, 0);
  const auto join = [](int, int) { return true; };
  shortcut_pieces(all, join, [] { return true; });
  Rng rng(1);
  shortcut_at_random(
      all, 100, rng, [](std::size_t, std::size_t, std::vector<int>&) { return true; }, [] { return true; });
  EXPECT_EQ(all.size(), 50u);
}

/// Forms are shown in order until one is accepted, and refusals are counted.
TEST(Candidates, ShowFormsUntilOneIsAccepted) {
  for (std::size_t accepted = 0; accepted <= 5; ++accepted)
    for (std::size_t learns = 0; learns <= 5; ++learns) {
      std::size_t shown = 0, taken = 0;
      const fake::RuleChecker checker([&](const Path& path) {
        EXPECT_EQ(path.size(), shown + 1) << "the forms in order";
        fake::Ruling ruling;
        ruling.accept = shown++ == accepted;
        return ruling;
      });
      std::uint64_t refused = 0;
      const Shown end = show_forms(
          checker, refused, [](std::size_t k) { return k < 5 ? std::optional(Path(k + 1)) : std::nullopt; },
          [&](const PathCheck&, const Path&) { return shown <= learns; },
          [&](const VerifiedPath& path) {
            ++taken;
            EXPECT_TRUE(checker.accepted(path));
          });
      const bool reached = accepted < 5 && learns >= accepted;
      EXPECT_EQ(end.accepted, reached);
      EXPECT_EQ(taken, reached ? 1u : 0u);
      EXPECT_EQ(refused, reached ? accepted : std::min<std::size_t>(learns + 1, 5));
      EXPECT_EQ(end.path.size(), shown) << "the last one shown";
    }
}

}  // namespace
}  // namespace dismantle::path
