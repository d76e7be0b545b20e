#include "steps.h"

#include <gtest/gtest.h>

namespace dismantle::checks {
namespace {

TEST(Steps, EachStepCostsOneWhateverItIs) {
  const Assembly assembly;
  const std::vector<PlacedPart> one{{0, {}}}, two{{1, {}}, {2, {}}};
  const StepQuestion first{assembly, one, {}},
      second{assembly, two, one, Eigen::Vector3d::UnitX(), nullptr, Eigen::Vector3d::UnitZ(), &first};
  EXPECT_EQ(Steps().judge(first, {}).cost, 1);
  EXPECT_EQ(Steps().judge(second, {}).cost, 1);
  EXPECT_TRUE(Steps().judge(first, {}).allowed);
}

}  // namespace
}  // namespace dismantle::checks
