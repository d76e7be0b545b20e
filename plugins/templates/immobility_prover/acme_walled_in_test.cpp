// Tests of acme.walled_in beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include "dismantle/host/registry.h"
#include "dismantle/part_memo.h"
#include "dismantle/testing/fake_planning.h"

namespace {

using dismantle::fake::Box;

/// A cube with half edge `half` in a closed case, or in a case without a lid.
dismantle::Assembly cube_in_case(double half, double wall, bool lid) {
  const double in = 1, out = in + wall;
  std::vector<Box> walls = {{{-out, -out, -out}, {out, out, -in}},
                            {{-out, -out, -in}, {-in, out, in}},
                            {{in, -out, -in}, {out, out, in}},
                            {{-in, -out, -in}, {in, -in, in}},
                            {{-in, in, -in}, {in, out, in}}};
  dismantle::Assembly assembly =
      dismantle::fake::assembly_of({{"case", walls}, {"cube", {{{-half, -half, -half}, {half, half, half}}}}});
  if (lid) {  // one closed surface with a cavity
    const dismantle::shapes::Vec3 corner(out, out, out);
    assembly.parts[0].mesh = assembly.parts[0].surface =
        std::make_shared<const dismantle::Mesh>(dismantle::shapes::closed_box(-corner, corner, wall));
  }
  return assembly;
}

std::optional<dismantle::Certificate> prove(const dismantle::Assembly& assembly, double tolerance) {
  dismantle::Registry registry;
  registry.load(PLUGIN_FILE);
  dismantle::PartMemo memo;
  const dismantle::SeparationQuery query{assembly, {{1, {}}}, {{0, {}}}, tolerance, 1, memo};
  return registry.create<dismantle::ImmobilityProver>("acme.walled_in")->prove(query, {});
}

TEST(AcmeWalledIn, ACubeInAClosedCaseStays) {
  dismantle::Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const double half = rng.uniform(0.1, 0.9), wall = rng.uniform(0.01, 0.5);
    const auto found = prove(cube_in_case(half, wall, true), 0.01);
    ASSERT_TRUE(found) << half << " " << wall;
    EXPECT_EQ(found->parts, (std::vector<dismantle::PartId>{1, 0}));
    EXPECT_GT(found->numbers.at("depth").front(), 0.01);
    EXPECT_LE(found->numbers.at("depth").front(), half);
  }
}

TEST(AcmeWalledIn, WithoutALidNothingIsClaimed) {
  dismantle::Rng rng(2);
  for (int trial = 0; trial < 20; ++trial)
    EXPECT_FALSE(prove(cube_in_case(rng.uniform(0.1, 0.9), rng.uniform(0.01, 0.5), false), 0.01));
}

TEST(AcmeWalledIn, WhatIsThinnerThanTheToleranceIsNotClaimed) {
  EXPECT_FALSE(prove(cube_in_case(0.1, 0.2, true), 0.11));  // no point of the cube is deeper than the tolerance
}

}  // namespace
