// Parts count as interlocked only when no motion of any of them, within half of the tolerance, leaves the bounds.
#include <gtest/gtest.h>

#include "dismantle/testing/trials.h"
#include "interlock_lp/interlock_lp.h"
#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::assembly_of;
using shapes::box;
using shapes::Keyed;
using shapes::moved;
using shapes::random_pose;
using shapes::Vec3;

constexpr double kTolerance = 0.004;

Keyed any_keyed(Rng& rng) {
  Keyed k;
  k.length = rng.uniform(0.5, 0.7);
  k.width = rng.uniform(0.3, 0.5);
  k.height = rng.uniform(0.3, 0.5);
  k.tongue = rng.uniform(0.25, 0.35);
  k.play = rng.uniform(0.001, 0.004);
  k.roofed = rng.uniform(0.3, 0.45);
  return k;
}

ProverRig rig_of(const Keyed& k, const Pose& turned) {
  return {assembly_of({moved(k.slab(), turned), moved(k.tray(), turned), moved(k.block(), turned)}), kTolerance};
}

Verifier verifier_of(const ProverRig& rig, double allowed = kTolerance) { return Verifier(rig.assembly(), {allowed}); }

/// Certificate for motions that penetrate by half of the tolerance.
struct Interlocked {
  std::vector<PartId> parts;
  double depth = 0, shift = 0, turn = 0, half_spaces = 0;
};
std::optional<Interlocked> interlocked(const ProverRig& rig, const std::vector<PartId>& parts,
                                       const RunContext& context = {}) {
  const auto c =
      rig.prove(InterlockLp{}, {parts.begin(), parts.begin() + 1}, {parts.begin() + 1, parts.end()}, 0.5, context);
  if (!c) return std::nullopt;
  EXPECT_EQ(rig.objection(InterlockLp{}, "interlock_lp", *c, 0.5), "");
  for (const PartId id : parts) EXPECT_NE(c->text.find(rig.assembly().parts[id].name), std::string::npos) << c->text;
  const auto number = [&](const char* name) { return c->numbers.at(name).front(); };
  return Interlocked{c->parts, number("depth"), number("shift"), number("turn"), number("half_spaces")};
}

TEST(Interlocked, EachHeldByTheOthersTogether) {
  Rng rng(1);
  for (int i = 0; i < testing_support::trials(2, 8); ++i) {
    const Keyed k = any_keyed(rng);
    const ProverRig rig = rig_of(k, random_pose(rng, 2));
    const auto found = interlocked(rig, {2, 0, 1});
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->parts, (std::vector<PartId>{0, 1, 2}));
    EXPECT_DOUBLE_EQ(found->depth, 0.5 * kTolerance);
    EXPECT_GE(found->shift, k.play) << "they do move as far as they have play";
    EXPECT_LT(found->shift, k.height) << "and stay where they were";
    EXPECT_GT(found->half_spaces, 0u);
    EXPECT_FALSE(interlocked(rig, {1, 2})) << "the block alone is lifted out";
    EXPECT_FALSE(interlocked(rig, {0, 2})) << "without the tray there is nothing beside them";
  }
}

TEST(Interlocked, NotWhereOneAfterTheOtherIsLiftedOut) {
  Rng rng(2);
  Keyed k = any_keyed(rng);
  k.roofed = 0;
  const ProverRig rig = rig_of(k, Pose{});
  EXPECT_TRUE(
      verifier_of(rig).check_motion({0}, {{1, Pose{}}, {2, Pose{}}}, {{Pose{}}, {shapes::shift({0, 0, 3})}}).valid);
  EXPECT_FALSE(interlocked(rig, {0, 1, 2}));
}

TEST(Interlocked, NotWhereTwoShiftTogetherAndOneComesOut) {
  Rng rng(3);
  Keyed k = any_keyed(rng);
  k.gap = k.roofed + 0.01;
  const ProverRig rig = rig_of(k, Pose{});
  const Pose aside = shapes::shift({k.gap, 0, 0}), out = shapes::shift({k.gap, 0, 3});
  EXPECT_TRUE(verifier_of(rig).check_motion({0, 2}, {{1, Pose{}}}, {{Pose{}, Pose{}}, {aside, aside}}).valid);
  EXPECT_TRUE(verifier_of(rig).check_motion({0}, {{1, Pose{}}, {2, aside}}, {{aside}, {out}}).valid);
  EXPECT_FALSE(interlocked(rig, {0, 1, 2}));
}

TEST(Interlocked, NotWhereASurfaceHasABorder) {
  Rng rng(4);
  const Keyed k = any_keyed(rng);
  for (int open = 0; open < 3; ++open) {
    std::vector<Mesh> meshes{k.slab(), k.tray(), k.block()};
    meshes[static_cast<std::size_t>(open)].triangles.pop_back();
    EXPECT_FALSE(interlocked(ProverRig(assembly_of(meshes), kTolerance), {0, 1, 2})) << open;
  }
}

TEST(Interlocked, NotWithWhatIsElsewhere) {
  Rng rng(5);
  const Keyed k = any_keyed(rng);
  const ProverRig rig(assembly_of({k.slab(), k.tray(), k.block(), box({5, 5, 5}, {6, 6, 6})}), kTolerance);
  EXPECT_TRUE(interlocked(rig, {0, 1, 2}));
  EXPECT_FALSE(interlocked(rig, {0, 1, 2, 3}));
}

TEST(Interlocked, WhateverTheJudgeOfThatDepthAcceptsStaysWithinTheBounds) {
  Rng rng(6);
  const Keyed k = any_keyed(rng);
  const auto found = interlocked(rig_of(k, Pose{}), {0, 1, 2});
  ASSERT_TRUE(found);
  const Verifier strict = verifier_of(rig_of(k, Pose{}), found->depth);
  const auto random = [&](double most) {
    return Vec3(most * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
  };
  int accepted = 0;
  for (int i = 0; i < 300; ++i) {
    // Both simultaneously, each about the centre of its box.
    Path displacement{{Pose{}, Pose{}}, {}};
    std::vector<double> turn, shift;
    const double share = rng.uniform(0.02, 0.5);
    for (const Mesh& m : {k.slab(), k.block()}) {
      const Vec3 w = random(share * found->turn), by = random(share * found->shift), c = m.box().center();
      const Eigen::Quaterniond q = rotation_from_vector(w);
      displacement[1].push_back({c + by - q * c, q});
      turn.push_back(w.norm());
      shift.push_back(by.norm());
    }
    if (!strict.check_motion({0, 2}, {{1, Pose{}}}, displacement).valid) continue;
    ++accepted;
    EXPECT_LE(*std::max_element(turn.begin(), turn.end()), found->turn);
    EXPECT_LE(*std::max_element(shift.begin(), shift.end()), found->shift);
  }
  EXPECT_GT(accepted, 10);
}

TEST(Interlocked, EndsWhenToldTo) {
  Rng rng(7);
  const ProverRig rig = rig_of(any_keyed(rng), Pose{});
  RunContext context;
  context.cancel.cancel();
  EXPECT_FALSE(interlocked(rig, {0, 1, 2}, context));
}

}  // namespace
}  // namespace dismantle::immobility
