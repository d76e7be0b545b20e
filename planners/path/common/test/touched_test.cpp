#include "dismantle/path/touched.h"

#include <gtest/gtest.h>

#include <set>

#include "dismantle/run_context.h"

namespace dismantle::path {
namespace {

TEST(Touched, MostOftenFirstAndNobodyWhoMoves) {
  const std::map<PartId, std::uint64_t> touched{{1, 3}, {2, 9}, {3, 3}, {4, 100}, {7, 1}};
  EXPECT_EQ(most_touched(touched, {{4, Pose{}}}), (std::vector<PartId>{2, 1, 3, 7}));
  EXPECT_EQ(most_touched(touched, {}).front(), 4U);
  EXPECT_TRUE(most_touched({}, {{1, Pose{}}}).empty());
}

TEST(TouchedParts, AreTheFixedOnesInContactEachOnce) {
  Rng rng(1);
  for (int round = 0; round < 100; ++round) {
    const double distance = rng.uniform(0.0, 0.01);
    std::vector<Contact> contacts(rng.below(30));
    std::set<PartId> expected;
    for (Contact& c : contacts) {
      c.other = static_cast<PartId>(rng.below(8));
      c.depth = rng.uniform(-0.01, 0.01);
      if (c.depth > -distance && c.other != 3 && c.other != 5) expected.insert(c.other);
    }
    EXPECT_EQ(touched_parts(contacts, {{3, Pose{}}, {5, Pose{}}}, distance),
              std::vector<PartId>(expected.begin(), expected.end()));
  }
}

}  // namespace
}  // namespace dismantle::path
