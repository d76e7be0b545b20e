// The verifier on several threads, and when told to stop.
#include <gtest/gtest.h>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::Vec3;

/// A ball passes a row of frames of random width: it clears, touches or penetrates them. In one segment, so that all
/// pairs are checked in parallel, or in two.
struct Row {
  Row(Rng& rng, double tight, bool in_one) {
    std::vector<Mesh> meshes{shapes::sphere(Vec3::Zero(), 0.5, 3)};
    for (int k = 0; k < 12; ++k) {
      const double radius = 0.5 + (rng.uniform() < 0.5 ? rng.uniform(-tight, 0.01) : 0.1);
      meshes.push_back(shapes::tube(radius, 1, k, k + 0.5, 40, 1, rng.uniform(0, 1)));
    }
    assembly = shapes::assembly_of(meshes);
    for (PartId id = 1; id < meshes.size(); ++id) fixed.push_back({id, Pose{}});
    path = {{shapes::shift({0, 0, -1})}, {shapes::shift({0, 0, 5})}, {shapes::shift({0, 0, 14})}};
    if (in_one) path.erase(path.begin() + 1);
  }
  Assembly assembly;
  std::vector<PlacedPart> fixed;
  Path path;
};

TEST(VerifierThreads, SameAnswerOnAnyNumberOfThreads) {
  Rng rng(1);
  const int rounds = testing_support::trials(8, 48);
  int valid = 0;
  for (int round = 0; round < rounds; ++round) {
    const Row row(rng, round % 2 == 0 ? 0.006 : 0.03, round % 4 < 2);
    MotionCheck first;
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
      RunContext context;
      context.threads = threads;
      if (threads > 2) context.executor = std::make_shared<Executor>(threads);  // else threads of its own
      const Verifier verifier(row.assembly, {0.01}, context);
      const MotionCheck check = verifier.check_motion({0}, row.fixed, row.path, context);
      if (threads == 1) {
        first = check;
        valid += check.valid ? 1 : 0;
      }
      EXPECT_EQ(check.valid, first.valid);
      EXPECT_EQ(check.max_penetration, first.max_penetration);
      EXPECT_EQ(check.tests, first.tests);
      ASSERT_EQ(check.violation.has_value(), first.violation.has_value());
      if (!check.violation) continue;
      EXPECT_EQ(check.violation->other, first.violation->other);
      EXPECT_EQ(check.violation->point, first.violation->point);
      EXPECT_EQ(check.violation->depth, first.violation->depth);
    }
  }
  EXPECT_GT(valid, rounds / 6);
  EXPECT_LT(valid, rounds - rounds / 6);
}

TEST(VerifierThreads, ToldToStopItSaysSoAndNothingElse) {
  Rng rng(2);
  for (const bool in_one : {true, false}) {
    const Row row(rng, 0.006, in_one);
    const Verifier verifier(row.assembly, {0.01});
    for (const unsigned threads : {1U, 2U}) {
      RunContext context;
      context.threads = threads;
      if (threads > 1) context.executor = std::make_shared<Executor>(threads);
      context.cancel.cancel();
      const MotionCheck check = verifier.check_motion({0}, row.fixed, row.path, context);
      EXPECT_FALSE(check.valid);
      EXPECT_TRUE(check.interrupted);
      EXPECT_FALSE(check.violation);
    }
  }
}

/// Small parts are prepared even when told to stop, so that the results so far can be checked.
TEST(VerifierThreads, ToldToStopItIsBuiltOnlyOfSmallParts) {
  RunContext context;
  context.cancel.cancel();
  const Mesh small = shapes::sphere({0, 0, 0}, 1, 3), large = shapes::sphere({3, 0, 0}, 1, 6);
  const Verifier whole(shapes::assembly_of({small, small}), {0.01}, context);
  EXPECT_EQ(whole.parts(), 2u);
  EXPECT_THROW(Verifier(shapes::assembly_of({small, large}), {0.01}, context), Error);
}

}  // namespace
}  // namespace dismantle
