// Parts count as caged only when no motion that penetrates by half of the tolerance separates them, for any shape and
// pose.
#include "configuration_cells/configuration_cells.h"

#include <gtest/gtest.h>

#include "configuration_cells/cell_decomposition.h"
#include "configuration_cells/free_space_sampler.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/testing/trials.h"
#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::append;
using shapes::assembly_of;
using shapes::box;
using shapes::Cased;
using shapes::inside_out;
using shapes::moved;
using shapes::Passage;
using shapes::random_pose;
using shapes::Vec3;

constexpr double kTolerance = 0.01;

Cased any_case(Rng& rng, double rim) {
  return {{rng.uniform(0.4, 0.7), rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5)},
          rng.uniform(0.005, 0.03),
          rim,
          rng.uniform(0.1, 0.2)};
}

ProverRig rig_of(const Cased& c, const Pose& turned) {
  return {assembly_of({moved(c.block(), turned), moved(c.around(), turned)}), kTolerance};
}

Verifier verifier_of(const ProverRig& rig, double allowed = kTolerance) { return Verifier(rig.assembly(), {allowed}); }

/// Certificate for motions that penetrate by half of the tolerance.
struct Confined {
  std::vector<PartId> parts;
  double depth = 0, shift = 0, turn = 0, cells = 0;
};
std::optional<Confined> confined(const ProverRig& rig, PartId a = 0, PartId b = 1, const RunContext& context = {}) {
  const auto c = rig.prove(ConfigurationCells{}, {a}, {b}, 0.5, context);
  if (!c) return std::nullopt;
  EXPECT_EQ(rig.objection(ConfigurationCells{}, "configuration_cells", *c, 0.5), "");
  const auto number = [&](const char* name) { return c->numbers.at(name).front(); };
  return Confined{c->parts, number("depth"), number("shift"), number("turn"), number("cells")};
}

TEST(ConfigurationCells, ABlockUnderARim) {
  Rng rng(1);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const Cased c = any_case(rng, rng.uniform(0.08, 0.15));
    const ProverRig rig = rig_of(c, random_pose(rng, 2));
    const auto found = confined(rig);
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->parts, (std::vector<PartId>{0, 1}));
    EXPECT_DOUBLE_EQ(found->depth, 0.5 * kTolerance);
    EXPECT_GE(found->shift, c.play) << "it does move as far as it has play";
    EXPECT_LT(found->shift, c.half.z()) << "and stays where it was";
  }
}

TEST(ConfigurationCells, NotWhereItComesOut) {
  Rng rng(2);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const Cased c =
        any_case(rng, i % 2 == 0 ? rng.uniform(-0.02, 0) : rng.uniform(0.002, 0.0027));  // < half of what is allowed
    const ProverRig rig = rig_of(c, Pose{});
    EXPECT_TRUE(verifier_of(rig).check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {shapes::shift({0, 0, 3})}}).valid);
    EXPECT_FALSE(confined(rig)) << i;
  }
}

TEST(ConfigurationCells, NotWhereTheWayOutIsRoundACorner) {
  // Along a tunnel, and up through a hole in its roof with 0.006 to spare on every side.
  const double half = 0.2, wide = half + 0.006, hole = 0.5;
  const Mesh block = box({-half, -half, -half}, {half, half, half});
  Mesh tunnel = box({-0.5, -0.5, -0.5}, {1, 0.5, -wide});
  for (const double s : {-1.0, 1.0})
    append(tunnel, box({-0.5, std::min(s * wide, s * 0.5), -wide}, {1, std::max(s * wide, s * 0.5), 0.5}));
  append(tunnel, box({-0.5, -wide, -wide}, {-wide, wide, 0.5}));
  append(tunnel, box({hole + wide, -wide, -wide}, {1, wide, 0.5}));
  append(tunnel, box({-wide, -wide, wide}, {hole - wide, wide, 0.5}));
  const ProverRig rig(assembly_of({block, tunnel}), kTolerance);
  const Path out{{Pose{}}, {shapes::shift({hole, 0, 0})}, {shapes::shift({hole, 0, 2})}};
  ASSERT_TRUE(verifier_of(rig).check_motion({0}, {{1, Pose{}}}, out).valid);
  EXPECT_FALSE(confined(rig));
}

TEST(ConfigurationCells, NotWhereTheWayOutIsRoundTwoCorners) {
  Rng rng(8);
  for (int i = 0; i < testing_support::trials(1, 6); ++i) {
    const Passage p{rng.uniform(0.15, 0.25), rng.uniform(0.003, 0.02), true};
    const Pose at = random_pose(rng, 2);
    const ProverRig rig(assembly_of({moved(p.cube(), at), moved(p.around(), at)}), kTolerance);
    const auto by = [&](double x, double y, double z) { return shapes::shift(at.q * (p.step() * Vec3(x, y, z))); };
    const Path out{{Pose{}}, {by(1, 0, 0)}, {by(1, 1, 0)}, {by(1, 1, 8)}};
    ASSERT_TRUE(verifier_of(rig).check_motion({0}, {{1, Pose{}}}, out).valid) << i;
    EXPECT_FALSE(confined(rig)) << i;
  }
}

TEST(ConfigurationCells, ACubeThatSlidesRoundACorner) {
  const Passage p{0.2, 0.003, false};
  const ProverRig rig(assembly_of({p.cube(), p.around()}), kTolerance);
  const auto found = confined(rig);
  ASSERT_TRUE(found);
  EXPECT_GE(found->shift, p.step()) << "it gets to the corner at least";
}

TEST(ConfigurationCells, ABlockThatSlidesFar) {
  Rng rng(9);
  for (int i = 0; i < testing_support::trials(1, 6); ++i) {
    const double slide = rng.uniform(0.5, 2), play = rng.uniform(0.003, 0.015);
    const Vec3 half(rng.uniform(0.4, 0.7), rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5));
    const Vec3 in = half.array() + play, out = in.array() + 0.3, far(slide, 0, 0);
    Mesh channel = box(-out, out + far);
    append(channel, inside_out(box(-in, in + far)));
    const Pose at = random_pose(rng, 2);
    const ProverRig rig(assembly_of({moved(box(-half, half), at), moved(channel, at)}), kTolerance);
    const auto found = confined(rig);
    ASSERT_TRUE(found) << i;
    EXPECT_GE(found->shift, slide) << i;
    EXPECT_LT(found->shift, slide + 0.3) << "within the walls";
  }
}

// A ring in a groove turns without end: no box holds its poses. That is seen before a cell is divided.
TEST(ConfigurationCells, APartThatTurnsFreelyIsGivenUpWithoutDivisions) {
  Rng rng(6);
  for (int i = 0; i < testing_support::trials(3, 20); ++i) {
    const Pose world = random_pose(rng, 2);
    const double play = rng.uniform(0.05, 0.1);
    Mesh shaft = shapes::tube(0, 1.2, -2, -0.3, 32);
    append(shaft, shapes::tube(0, 0.8, -0.3, 0.3, 32));
    append(shaft, shapes::tube(0, 1.2, 0.3, 2, 32));
    const auto solids = [&](const Mesh& mesh) { return geometry::split_into_solids(moved(mesh, world)); };
    const auto ring = solids(shapes::tube(0.8 + play, 1.6, play - 0.3, 0.3 - play, 32)), around = solids(shaft);
    const SampledPair pair(ring, around, 0.5 * kTolerance, ConfigurationCellsParameters{}.sample_spacing * kTolerance);
    ConfigurationCellsParameters params;
    params.max_divisions = 1;
    FreeSpaceSampler sampler(pair, pair.radius(), kTolerance);
    sampler.explore(static_cast<std::size_t>(params.walk_checks), RunContext{});
    const RunContext context;
    ForkJoin fork_join(context);
    CellDecomposition cells(pair, sampler, params, {2 * pair.radius(), kTolerance}, fork_join);
    EXPECT_EQ(cells.run(context), CellDecomposition::End::open) << i;
  }
}

TEST(ConfigurationCells, NotWhereNothingIsAround) {
  const ProverRig rig(assembly_of({box({0, 0, 0}, {1, 1, 1}), box({0, 0, 1.005}, {1, 1, 2})}), kTolerance);
  EXPECT_FALSE(confined(rig));
  const ProverRig far(assembly_of({box({0, 0, 0}, {1, 1, 1}), box({0, 0, 5}, {1, 1, 6})}), kTolerance);
  EXPECT_FALSE(confined(far));
}

TEST(ConfigurationCells, NotWhereASurfaceHasABorder) {
  Rng rng(7);
  const Cased c = any_case(rng, 0.1);
  for (const bool inner : {true, false}) {
    Mesh block = c.block(), around = c.around();
    (inner ? block : around).triangles.pop_back();
    EXPECT_FALSE(confined(ProverRig(assembly_of({block, around}), kTolerance)));
  }
}

TEST(ConfigurationCells, EveryMotionThatTheVerifierAcceptsStaysWithinTheBounds) {
  Rng rng(3);
  const Cased c = any_case(rng, 0.1);
  const auto found = confined(rig_of(c, Pose{}));
  ASSERT_TRUE(found);
  const Verifier strict = verifier_of(rig_of(c, Pose{}), found->depth);
  int accepted = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 by = 2 * found->shift * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Vec3 turn = 2 * found->turn * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const double share = rng.uniform(0.02, 1);
    const Pose to{share * by, rotation_from_vector(share * turn)};
    if (!strict.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {to}}).valid) continue;
    ++accepted;
    EXPECT_LE(to.t.norm(), found->shift);
    EXPECT_LE((share * turn).norm(), found->turn);
  }
  EXPECT_GT(accepted, 10);
}

TEST(ConfigurationCells, TheSameOnTwoThreadsAndEitherWayRound) {
  Rng rng(4);
  const ProverRig rig = rig_of(any_case(rng, 0.1), Pose{});
  const auto one = confined(rig);
  RunContext context;
  context.executor = std::make_shared<Executor>(2);
  const auto two = confined(rig, 1, 0, context);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->parts, two->parts);
  EXPECT_EQ(one->cells, two->cells);
  EXPECT_EQ(one->shift, two->shift);
  EXPECT_EQ(one->turn, two->turn);
}

TEST(ConfigurationCells, EndsWhenToldTo) {
  Rng rng(5);
  const ProverRig rig = rig_of(any_case(rng, 0.1), Pose{});
  RunContext context;
  context.cancel.cancel();
  EXPECT_FALSE(confined(rig, 0, 1, context));
}

TEST(ConfigurationCells, ItsCertificateHoldsAndNamesThePartsAndBounds) {
  Rng rng(6);
  const ProverRig rig = rig_of(any_case(rng, 0.1), Pose{});
  for (const double share : {0.5, 1.0}) {
    auto c = rig.prove(ConfigurationCells{}, {0}, {1}, share);
    ASSERT_TRUE(c) << share;
    for (const char* part : {"'part0'", "'part1'"}) EXPECT_NE(c->text.find(part), std::string::npos) << c->text;
    EXPECT_EQ(rig.objection(ConfigurationCells{}, "configuration_cells", *c, share), "");
    c->numbers.at("shift").front() *= 0.5;
    EXPECT_NE(rig.objection(ConfigurationCells{}, "configuration_cells", *c, share), "");
  }
}

}  // namespace
}  // namespace dismantle::immobility
