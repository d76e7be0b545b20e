#include "dismantle/path/touched.h"

#include <gtest/gtest.h>

namespace dismantle::path {
namespace {

TEST(Touched, MostOftenFirstAndNobodyWhoMoves) {
  const std::map<PartId, std::uint64_t> touched{{1, 3}, {2, 9}, {3, 3}, {4, 100}, {7, 1}};
  EXPECT_EQ(most_touched(touched, {{4, Pose{}}}), (std::vector<PartId>{2, 1, 3, 7}));
  EXPECT_EQ(most_touched(touched, {}).front(), 4U);
  EXPECT_TRUE(most_touched({}, {{1, Pose{}}}).empty());
}

}  // namespace
}  // namespace dismantle::path
