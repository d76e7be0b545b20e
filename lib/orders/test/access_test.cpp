// The depth of every part, compared with brute force that finds removals by itself.
#include "dismantle/orders/access.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "dismantle/testing/lattice.h"

namespace dismantle {
namespace {

/// Costs 1 for a change of the direction.
class Turns final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override {
    return {.remembers_direction = true, .reads_present = false, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    StepVerdict verdict;
    verdict.cost = q.previous != nullptr && q.previous->direction.dot(q.direction) < 0.9 ? 1 : 0;
    return verdict;
  }
};

TEST(Access, IsTheFewestStepsToEveryPartOfBlocksOnALattice) {
  Rng rng(55);
  std::map<std::size_t, unsigned> by_depth;
  unsigned never = 0;
  const Objective turns{{{"turns", std::make_shared<Turns>(), 0.5, false}}};
  for (int trial = 0; trial < 24; ++trial) {
    const fake::Lattice lattice = fake::Lattice::random(rng, trial % 3 == 1, trial % 4 != 0);
    const Assembly assembly = lattice.assembly();
    const Verifier verifier(assembly, VerifyOptions{});
    const Disassembly nothing(assembly.parts.size());
    const RunContext context;
    const Objective none;
    Access steps(assembly, nothing, lattice.constraints, none, verifier, context);
    Access costs(assembly, nothing, lattice.constraints, turns, verifier, context);
    for (PartId part = 0; part < lattice.parts; ++part) {
      const auto truth = lattice.fewest_steps(part);
      const PartAccess access = steps.to(part), cheap = costs.to(part);
      EXPECT_EQ(access.unit, std::vector<PartId>{part});
      if (!truth) {
        ++never;
        EXPECT_TRUE(access.steps.empty()) << trial << " part " << part;
        continue;
      }
      ++by_depth[access.depth()];
      EXPECT_EQ(access.depth(), truth->first) << trial << " part " << part;
      EXPECT_EQ(access.least_depth, truth->first) << trial << " part " << part;
      EXPECT_TRUE(access.optimal);
      EXPECT_FALSE(access.cost.has_value());
      EXPECT_EQ(cheap.depth(), truth->first) << trial << " part " << part;
      EXPECT_NEAR(cheap.cost.value_or(-1), 0.5 * truth->second, 1e-6) << trial << " part " << part;
      EXPECT_TRUE(cheap.cheapest);
      // Its steps are possible, and in the end the part is by itself.
      std::vector<PartId> left;
      for (PartId id = 0; id < lattice.parts; ++id) left.push_back(id);
      for (const AccessStep& step : cheap.steps) {
        std::vector<PlacedPart> fixed;
        for (const PartId id : without(left, step.parts)) fixed.push_back({id, Pose{}});
        const Path path{std::vector<Pose>(step.parts.size()),
                        std::vector<Pose>(step.parts.size(), Pose{20 * step.direction, Pose{}.q})};
        EXPECT_TRUE(verifier.check_motion(step.parts, fixed, path).valid) << trial << " part " << part;
        left = without(left, step.parts);
      }
      EXPECT_TRUE(!contains(left, part) || left.size() == 1) << trial << " part " << part;
    }
  }
  EXPECT_GT(by_depth[1], 20u);
  EXPECT_GT(by_depth[3] + by_depth[4] + by_depth[5] + by_depth[6], 15u);
  EXPECT_GT(never, 5u);
}

TEST(Access, OfAPlanWithoutSearching) {
  const Assembly assembly = fake::tube_with_blocks(3);
  Disassembly plan(4);
  const auto out = [&](PartId part) {
    DisassemblyStep step;
    step.parts = {part};
    step.path = std::make_shared<const Trace>(Trace{{Pose{}}, {Pose{{0, 0, 20}, Pose{}.q}}});
    plan.add(std::move(step));
  };
  out(3);
  out(2);
  EXPECT_EQ(access_as_planned(3, plan, {}).depth(), 1u);
  EXPECT_EQ(access_as_planned(2, plan, {}).depth(), 2u);
  EXPECT_EQ(access_as_planned(1, plan, {}).depth(), 0u) << "it is not by itself yet";
  Constraints kept;
  kept.together = {{0, 1}};
  EXPECT_EQ(access_as_planned(1, plan, kept).depth(), 2u) << "with what stays together it is";
  EXPECT_EQ(access_as_planned(1, plan, kept).unit, (std::vector<PartId>{0, 1}));
  // When it is to stop, it says what the plan says.
  const Verifier verifier(assembly, VerifyOptions{});
  RunContext stopped;
  stopped.cancel.cancel();
  const Objective none;
  Access access(assembly, plan, kept, none, verifier, stopped);
  EXPECT_EQ(access.to(2).depth(), 2u);
  EXPECT_FALSE(access.to(2).optimal);
}

}  // namespace
}  // namespace dismantle
