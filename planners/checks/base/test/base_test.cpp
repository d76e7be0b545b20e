#include "base.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

std::vector<PlacedPart> placed(const std::vector<PartId>& ids) {
  std::vector<PlacedPart> all;
  for (const PartId id : ids) all.push_back({id, Pose{}});
  return all;
}

/// A plan that puts parts in one after another, in this order; the first one is the base.
StepVerdict plan_of(const Assembly& assembly, const std::vector<PartId>& order,
                    const Vector3d& up = Vector3d::UnitZ()) {
  const std::vector<PlacedPart> all = placed(order);
  const std::span<const PlacedPart> parts(all);
  std::vector<StepQuestion> operations;
  for (std::size_t k = 1; k < all.size(); ++k)
    operations.push_back({assembly, parts.subspan(k, 1), parts.first(k), -up, nullptr, up});
  const Base base;
  const StepVerdict verdict = base.judge_plan(operations, RunContext{});
  EXPECT_EQ(verdict.reason.empty(), verdict.cost == 0);
  // What a search is told of the first step is what the plan says; the other steps, and judge(), say nothing.
  EXPECT_EQ(base.estimate(operations.front(), RunContext{}).cost, verdict.cost);
  EXPECT_EQ(base.judge(operations.front(), RunContext{}).cost, 0);
  StepQuestion later = operations.back();
  later.previous = &operations.front();
  EXPECT_EQ(base.estimate(later, RunContext{}).cost, 0);
  return verdict;
}

/// A plate (0) with blocks on it, one of them (the last) on another.
Assembly plate_with_blocks(const Pose& pose = {}, double scale = 1) {
  std::vector<Mesh> meshes{shapes::box({0, 0, 0}, {10, 10, 1})};
  for (int k = 0; k < 4; ++k) meshes.push_back(shapes::box({2.5 * k, 0, 1}, {2.5 * k + 2, 2, 3}));
  meshes.push_back(shapes::box({0, 0, 3}, {1, 1, 4}));
  for (Mesh& m : meshes) {
    for (auto& v : m.vertices) v *= scale;
    m = shapes::moved(m, pose);
  }
  return shapes::assembly_of(meshes);
}

TEST(Base, TheLargestLowestPartWithTheMostNeighboursCostsNothing) {
  const Assembly assembly = plate_with_blocks();
  EXPECT_EQ(plan_of(assembly, {0, 1, 2, 3, 4, 5}).cost, 0);
  const StepVerdict v = plan_of(assembly, {5, 1, 0, 2, 3, 4});
  EXPECT_GT(v.cost, 0.7);
  EXPECT_NE(v.reason.find("'part5'"), std::string::npos) << v.reason;
}

// Law: the cost depends on the base only, lies in [0, 1], and is the same in any unit and place, and however the whole
// with `up` is turned by quarters.
TEST(Base, DoesNotDependOnOrderUnitOrPlace) {
  Rng rng(4);
  const Assembly assembly = plate_with_blocks();
  for (PartId base = 0; base < 6; ++base) {
    std::vector<PartId> order{base};
    for (PartId id = 0; id < 6; ++id)
      if (id != base) order.push_back(id);
    const double cost = plan_of(assembly, order).cost;
    EXPECT_GE(cost, 0);
    EXPECT_LE(cost, 1);
    for (int k = 0; k < 10; ++k) {
      std::swap(order[1 + rng.below(5)], order[1 + rng.below(5)]);
      EXPECT_EQ(plan_of(assembly, order).cost, cost);
      const Pose turn{
          shapes::random_vector(rng, -5, 5),
          Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::Unit(static_cast<int>(rng.below(3)))))};
      EXPECT_NEAR(plan_of(plate_with_blocks(turn, rng.uniform(0.1, 30)), order, turn.q * Vector3d::UnitZ()).cost, cost,
                  1e-9);
    }
  }
}

// Law: upside down, a base at the top is the lowest part, and the other way round.
TEST(Base, LowIsAlongUp) {
  const Assembly pair = shapes::assembly_of({shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0, 0, 1}, {1, 1, 2})});
  EXPECT_NEAR(plan_of(pair, {0, 1}).cost, 0, 1e-12);
  EXPECT_NEAR(plan_of(pair, {1, 0}).cost, 0.5 / 3, 1e-12);
  EXPECT_NEAR(plan_of(pair, {0, 1}, -Vector3d::UnitZ()).cost, 0.5 / 3, 1e-12);
  EXPECT_NEAR(plan_of(pair, {1, 0}, -Vector3d::UnitZ()).cost, 0, 1e-12);
}

// Law: groups that are built apart have no say; whatever comes first, the base is what the whole is put on.
TEST(Base, GroupsBuiltApartAreNotTheBase) {
  const Assembly assembly = plate_with_blocks();
  const auto base = placed({0}), b1 = placed({1}), b2 = placed({2}), group = placed({3, 4, 5}), g3 = placed({3}),
             g34 = placed({3, 4}), g4 = placed({4}), g5 = placed({5}), on1 = placed({0, 1}), on2 = placed({0, 1, 2});
  const auto step = [&](const std::vector<PlacedPart>& moving, const std::vector<PlacedPart>& present) {
    return StepQuestion{assembly, moving, present, -Vector3d::UnitZ()};
  };
  const std::vector<StepQuestion> first{step(g4, g3), step(g5, g34), step(b1, base), step(b2, on1), step(group, on2)};
  const std::vector<StepQuestion> between{step(b1, base), step(g4, g3), step(b2, on1), step(g5, g34), step(group, on2)};
  EXPECT_EQ(Base().judge_plan(first, RunContext{}).cost, 0);
  EXPECT_EQ(Base().judge_plan(between, RunContext{}).cost, 0);
  const std::vector<StepQuestion> alone{step(g4, g3), step(g5, g34)};
  EXPECT_GT(Base().judge_plan(alone, RunContext{}).cost, 0.2);
}

}  // namespace
}  // namespace dismantle::checks
