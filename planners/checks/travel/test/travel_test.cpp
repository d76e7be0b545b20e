#include "travel.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

/// A cube between two plates that are 10 long. It comes along x from `from`, or from `from` above.
struct Slit {
  explicit Slit(double gap, double scale = 1) {
    std::vector<Mesh> meshes{shapes::box({0, 4, 1 + gap}, {1, 5, 2 + gap}), shapes::box({0, 0, 0}, {10, 10, 1}),
                             shapes::box({0, 0, 2 + 2 * gap}, {10, 10, 3 + 2 * gap})};
    for (Mesh& m : meshes) {
      m = shapes::refine(m, 4);
      for (auto& v : m.vertices) v *= scale;
    }
    assembly = shapes::assembly_of(meshes);
  }
  StepQuestion question(const std::vector<PartId>& ids, const Trace& path) {
    present.clear();
    for (const PartId id : ids) present.push_back({id, Pose{}});
    return {assembly, moving, present, (path.back()[0].t - path.front()[0].t).normalized(), &path};
  }
  Assembly assembly;
  std::vector<PlacedPart> moving{{0, Pose{}}}, present;
};

Trace displacement(const Vector3d& from) { return {{shapes::shift(from)}, {Pose{}}}; }

// Law: only the part of the way within the gap costs something, in any unit: the rest may be as long as it likes.
TEST(Travel, CostsTheLengthOfTheSlit) {
  Rng rng(5);
  for (int k = 0; k < 10; ++k) {
    const double scale = rng.uniform(0.1, 30);
    Slit tight(0.05, scale);
    const Trace path = displacement({-rng.uniform(2, 30) * scale, 0, 0});
    const StepVerdict v = Travel().judge(tight.question({1, 2}, path), RunContext{});
    EXPECT_NEAR(v.cost, 0.1, 0.05) << "the cube is one tenth of the assembly";
    EXPECT_NE(v.reason.find("% of the way"), std::string::npos);
    Slit wide(0.5, scale);
    EXPECT_EQ(Travel().judge(wide.question({1, 2}, path), RunContext{}).cost, 0);
    EXPECT_EQ(Travel().judge(wide.question({1, 2}, path), RunContext{}).reason, "");
  }
}

TEST(Travel, PushedThroughCostsMoreThanSetDown) {
  Slit slit(0.05);
  const Trace through = displacement({11, 0, 0}), down = displacement({0, 0, 11});
  EXPECT_NEAR(Travel().judge(slit.question({1, 2}, through), RunContext{}).cost, 1.1, 0.1);
  EXPECT_LT(Travel().judge(slit.question({1}, down), RunContext{}).cost, 0.05);
  EXPECT_EQ(Travel().judge(slit.question({}, through), RunContext{}).cost, 0) << "nothing is there";
}

// Law: a wider gap never costs less, and boxes are never farther apart than what is in them.
TEST(Travel, MoreIsCloseWithAWiderGapAndByBoxes) {
  Rng rng(11);
  unsigned open = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<Mesh> meshes;
    for (int i = 0; i < 4; ++i)
      meshes.push_back(shapes::moved(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::random_pose(rng, 2)));
    const Assembly assembly = shapes::assembly_of(meshes);
    const std::vector<PlacedPart> all{{0, Pose{}}, {1, Pose{}}, {2, Pose{}}, {3, Pose{}}};
    const std::span<const PlacedPart> parts(all);
    const Trace path{{shapes::random_pose(rng, 5)}, {shapes::random_pose(rng, 3)}, {Pose{}}};
    const StepQuestion question{assembly, parts.first(1), parts.subspan(1), Vector3d::UnitX(), &path};
    const double near = Travel({.gap = 0.02}).judge(question, RunContext{}).cost;
    EXPECT_LE(near, Travel({.gap = 0.2}).judge(question, RunContext{}).cost);
    EXPECT_LE(near, Travel({.gap = 0.02}).estimate(question, RunContext{}).cost);
    open += near == 0 ? 1 : 0;
  }
  EXPECT_LT(open, 60u);
}

}  // namespace
}  // namespace dismantle::checks
