#include "dismantle/statics/holds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "dismantle/statics/certificates.h"
#include "dismantle/testing/trials.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;

bool meets(const HoldGroup& group, const std::vector<std::uint32_t>& set) {
  return std::any_of(group.bodies.begin(), group.bodies.end(),
                     [&](std::uint32_t i) { return std::find(set.begin(), set.end(), i) != set.end(); });
}

TEST(Holds, CarryTheProofThatFewerDoNotSuffice) {
  std::mt19937 random(5);
  KnownJudgements known;
  std::size_t groups = 0, proved = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const Pile pile = pile_of(random_blocks(random, 3 + trial % 6), 1, 0.4);
    const Holds holds = least_holds_by_forces(pile, {}, &known);
    ASSERT_TRUE(holds.found) << trial;
    if (!holds.proved) continue;  // a block that is pressed in needs a hand, and does not fall
    ++proved;
    Pile held = pile;
    for (const std::uint32_t i : holds.held) held.bodies[i].fixed = true;
    EXPECT_EQ(check_equilibrium(held, holds.forces), "") << trial;
    for (const HoldGroup& g : holds.groups) {
      EXPECT_EQ(check_fall(pile, g.motion), "") << trial;
      for (std::uint32_t i = 0; i < pile.bodies.size(); ++i)
        EXPECT_TRUE(g.motion[i].v.isZero(0) || std::find(g.bodies.begin(), g.bodies.end(), i) != g.bodies.end());
    }
    groups += holds.groups.size();
    // No set with one body less meets all groups.
    for (unsigned set = 0; set < (1u << pile.bodies.size()) && !holds.held.empty(); ++set) {
      if (static_cast<std::size_t>(__builtin_popcount(set)) + 1 != holds.held.size()) continue;
      std::vector<std::uint32_t> fewer;
      for (std::uint32_t i = 0; i < pile.bodies.size(); ++i)
        if ((set >> i & 1u) != 0) fewer.push_back(i);
      EXPECT_FALSE(
          std::all_of(holds.groups.begin(), holds.groups.end(), [&](const HoldGroup& g) { return meets(g, fewer); }));
    }
    // What is known already changes nothing.
    const Holds again = least_holds_by_forces(pile, {}, &known), fresh = least_holds_by_forces(pile);
    EXPECT_EQ(again.held, fresh.held);
    EXPECT_EQ(holds.held, fresh.held);
  }
  EXPECT_GT(groups, 20u);
  EXPECT_GT(proved, 80u);
}

/// The least number of bodies that have to be fixed so that `stands`, by trying all sets.
template <class Stands>
std::size_t by_brute_force(const Pile& pile, Stands&& stands) {
  const auto n = static_cast<unsigned>(pile.bodies.size());
  for (int count = 0;; ++count)
    for (unsigned set = 0; set < (1u << n); ++set) {
      if (__builtin_popcount(set) != count) continue;
      Pile held = pile;
      for (unsigned i = 0; i < n; ++i)
        if ((set >> i & 1u) != 0) held.bodies[i].fixed = true;
      if (stands(held)) return static_cast<std::size_t>(count);
    }
}

TEST(Holds, AreAsFewAsBruteForceFinds) {
  std::mt19937 random(17);
  const int trials = testing_support::trials(25, 500);
  std::size_t most = 0;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const int n = 2 + static_cast<int>(random() % 8);
    const Pile pile = pile_of(trial % 2 == 0 ? random_blocks(random, n) : random_boxes(random, n), 1, 0.4);
    const Holds holds = least_holds(pile);
    ASSERT_TRUE(holds.found);
    EXPECT_EQ(holds.held.size(),
              by_brute_force(pile, [](const Pile& p) { return judge(p).verdict == Verdict::stands; }));
    most = std::max(most, holds.held.size());
  }
  EXPECT_GT(most, 1u);
}

}  // namespace
}  // namespace dismantle::statics
