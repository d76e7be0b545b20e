// How far an invalid motion is valid, against closed forms.
#include "dismantle/verification/valid_stretch.h"

#include <gtest/gtest.h>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::shift;
using shapes::Vec3;

const VerifyOptions kOptions;

double reached(const Assembly& assembly, const Path& path) {
  const auto place = valid_until(assembly, Verifier(assembly, kOptions), {0}, {{1, Pose{}}}, path, RunContext{});
  return place.value_or(-1);
}

TEST(ValidStretch, ACubeComesToTheWall) {
  Rng rng(3);
  for (int i = 0; i < 8; ++i) {
    const double gap = rng.uniform(0.1, 4), wall = rng.uniform(0.5, 1.5), displacement = gap + wall + 3;
    const Pose world = shapes::random_pose(rng, 2);
    const Assembly assembly =
        shapes::assembly_of({shapes::moved(shapes::box({-1, -1, -1}, {0, 1, 1}), world),
                             shapes::moved(shapes::box({gap, -3, -3}, {gap + wall, 3, 3}), world)});
    const auto along = [&](double x) { return std::vector<Pose>{shift(world.q * Vec3(x, 0, 0))}; };
    const double straight = reached(assembly, {along(0), along(displacement)}) * displacement;
    EXPECT_NEAR(straight, gap, 2.1 * kOptions.max_penetration) << "gap " << gap;
    // Instants in between change nothing.
    const double first = rng.uniform(0.1, displacement), second = rng.uniform(first, displacement);
    const Path path{along(0), along(first), along(second), along(displacement)};
    const double place = reached(assembly, path);
    EXPECT_NEAR((instant_at(path, place)[0].t).norm(), gap, 2.1 * kOptions.max_penetration) << "gap " << gap;
  }
}

TEST(ValidStretch, FromTheBeginningAndToTheEnd) {
  const Assembly touching =
      shapes::assembly_of({shapes::box({-1, -1, -1}, {0, 1, 1}), shapes::box({0, -3, -3}, {1, 3, 3})});
  EXPECT_LE(reached(touching, {{Pose{}}, {shift({5, 0, 0})}}) * 5, 2.1 * kOptions.max_penetration);
  EXPECT_EQ(reached(touching, {{Pose{}}, {shift({-5, 0, 0})}}), 1) << "it is valid as a whole";
}

TEST(ValidStretch, NothingIsSaidWhenToldToStop) {
  const Assembly assembly =
      shapes::assembly_of({shapes::box({-1, -1, -1}, {0, 1, 1}), shapes::box({1, -3, -3}, {2, 3, 3})});
  RunContext context;
  context.cancel.cancel();
  EXPECT_EQ(
      valid_until(assembly, Verifier(assembly, kOptions), {0}, {{1, Pose{}}}, {{Pose{}}, {shift({5, 0, 0})}}, context),
      std::nullopt);
}

// Law: what divides a path is its last valid instant, and dividing again changes nothing but by the resolution.
TEST(ValidStretch, ADividedPathSaysWhereItIsValid) {
  Rng rng(9);
  for (int i = 0; i < 20; ++i) {
    const double gap = rng.uniform(0, 4);
    const Assembly assembly =
        shapes::assembly_of({shapes::box({-1, -1, -1}, {0, 1, 1}), shapes::box({gap, -3, -3}, {gap + 1, 3, 3})});
    const Verifier verifier(assembly, kOptions);
    const Path path{{Pose{}}, {shift({rng.uniform(0, 2), 0, 0})}, {shift({9, 0, 0})}};
    const Path divided = divided_where_valid(assembly, verifier, {0}, {{1, Pose{}}}, path, RunContext{});
    ASSERT_LE(divided.size(), path.size() + 1);
    const std::size_t k = last_valid_instant(verifier, {0}, {{1, Pose{}}}, divided, RunContext{});
    ASSERT_GT(k, 0U) << "the tolerance allows a little";
    EXPECT_NEAR(divided[k][0].t.x(), gap, 2.1 * kOptions.max_penetration);
    EXPECT_EQ(divided.front()[0], path.front()[0]);
    EXPECT_EQ(divided.back()[0], path.back()[0]);
  }
}

}  // namespace
}  // namespace dismantle
