// Parts that leave only while others move in another way: a block that rises while the spindle in it turns (figure 9).
#include <gtest/gtest.h>

#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/trials.h"
#include "table.h"

namespace dismantle::contact_search {
namespace {

PathResult rise(const ParamSet& given, unsigned depth) {
  RunContext context;
  PrepareReport report;
  path::test::Table table(
      prepare_assembly(samples::make("interlock3", given), "interlock3", "", PrepareOptions{}, context, report), 1e-3);
  std::vector<PartId> moving;
  for (const Part& p : table.assembly.parts)
    if (p.name != "frame") moving.push_back(p.id);
  table.any_of = moving;
  return table.plan("contact_search", {}, 0, {.max_depth = depth}, moving);
}

/// The long motion begins among states that the block and the spindle reach singly, in their play, and parts that press
/// on each other are in contact all the way, at places that the world may not have seen.
TEST(ContactSearchIndependent, ABlockRisesWhileItsSpindleTurns) {
  Rng rng(3);
  for (int trial = 0; trial < testing_support::trials(1, 40); ++trial) {
    const double size = rng.uniform(8, 24), clearance = size * rng.uniform(0.008, 0.025), turn = rng.uniform(90, 360);
    SCOPED_TRACE(::testing::Message() << "size " << size << ", clearance " << clearance << ", turn " << turn);
    const PathResult result =
        rise({{"size", size}, {"turn", turn}, {"clearance", clearance}, {"rotate_seed", std::int64_t{trial * 7}}}, 4);
    EXPECT_EQ(result.outcome(), Outcome::solved) << result.message;
  }
}

/// A force on one part and a torque on the other are the last actions of the first level. Its work has to reach them
/// where no single force or torque drives both parts all the way: in this pose the block jams when it is pushed alone.
TEST(ContactSearchIndependent, TheFirstLevelReachesAForceWithATorque) {
  const PathResult result =
      rise({{"size", 12.0}, {"turn", 264.67}, {"clearance", 0.0884}, {"rotate_seed", std::int64_t{2366}}}, 1);
  EXPECT_EQ(result.outcome(), Outcome::solved) << result.message;
}

}  // namespace
}  // namespace dismantle::contact_search
