#include "dismantle/geometry/direction.h"

#include <gtest/gtest.h>

namespace dismantle {
namespace {

TEST(Direction, IsAnAxisOrThreeNumbers) {
  EXPECT_EQ(direction_named("x"), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(direction_named("+y"), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(direction_named("-z"), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(direction_named("0, -3 ,4"), Eigen::Vector3d(0, -0.6, 0.8));
  EXPECT_EQ(direction_named("0,0,1e-200"), Eigen::Vector3d(0, 0, 1));
  for (const char* text :
       {"", "-", "w", "--z", "xy", "0,0", "0,0,0", "0,0,1,", "0,0,1,2", "a,0,1", "0,,1", "nan,0,1", "inf,0,1"})
    EXPECT_EQ(direction_named(text), std::nullopt) << text;
}

}  // namespace
}  // namespace dismantle
