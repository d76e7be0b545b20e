#include "covers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

/// A block (0), a plate below it (1) and one above it (2), which begins at `x`.
struct Sandwich {
  explicit Sandwich(double x = 0, const Pose& pose = {}, double cover = 10, double scale = 1) : turn(pose.q) {
    std::vector<Mesh> meshes{shapes::box({4, 4, 1}, {6, 6, 2}), shapes::box({0, 0, 0}, {10, 10, 1}),
                             shapes::box({x, 0, 2}, {x + cover, cover, 3})};
    for (Mesh& m : meshes) {
      for (auto& v : m.vertices) v *= scale;
      m = shapes::moved(m, pose);
    }
    assembly = shapes::assembly_of(meshes);
  }
  StepVerdict verdict(const std::vector<PartId>& present, const Vector3d& direction) const {
    const std::vector<PlacedPart> moving{{0, Pose{}}};
    std::vector<PlacedPart> others;
    for (const PartId id : present) others.push_back({id, Pose{}});
    const StepVerdict v =
        Covers().judge({assembly, moving, others, turn * direction, nullptr, turn * Vector3d::UnitZ()}, RunContext{});
    EXPECT_EQ(v.reason.empty(), v.cost == 0);
    EXPECT_TRUE(v.allowed);
    return v;
  }
  Assembly assembly;
  Eigen::Quaterniond turn;
};

// Law: a part costs something exactly when it comes from the side under a larger part that is there already.
TEST(Covers, PartsComeBeforeTheirCovers) {
  const Sandwich s;
  EXPECT_EQ(s.verdict({1}, Vector3d::UnitX()).cost, 0) << "the cover is not there yet";
  EXPECT_EQ(s.verdict({1}, -Vector3d::UnitZ()).cost, 0);
  const StepVerdict v = s.verdict({1, 2}, Vector3d::UnitX());
  EXPECT_DOUBLE_EQ(v.cost, 1);
  EXPECT_NE(v.reason.find("'part2'"), std::string::npos) << v.reason;
  EXPECT_EQ(s.verdict({1, 2}, -Vector3d::UnitZ()).cost, 0) << "through a hole in the cover";
  EXPECT_EQ(s.verdict({1, 2}, Vector3d::UnitZ()).cost, 0);
  EXPECT_EQ(s.verdict({1, 2}, Vector3d::Zero()).cost, 0);
}

TEST(Covers, AShimIsNoCover) {
  const Sandwich s(4.5, {}, 1);
  EXPECT_EQ(s.verdict({1, 2}, Vector3d::UnitX()).cost, 0) << "the part above is smaller";
}

// Law: the cost is the covered share, in any unit and place, and however the assembly lies.
TEST(Covers, IsTheShareThatIsCovered) {
  Rng rng(6);
  for (int k = 0; k < 200; ++k) {
    const double x = rng.uniform(3, 7), share = std::clamp((6 - x) / 2, 0.0, 1.0);
    const Pose quarter{shapes::random_vector(rng, -5, 5),
                       Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi * static_cast<double>(rng.below(4)),
                                                            Vector3d::Unit(static_cast<int>(rng.below(3)))))};
    const Sandwich s(x, quarter, 10, rng.uniform(0.1, 40));
    EXPECT_NEAR(s.verdict({1, 2}, Vector3d::UnitX()).cost, share, 1e-9);
    EXPECT_NEAR(s.verdict({2, 1}, -Vector3d::UnitY()).cost, share, 1e-9);
  }
}

}  // namespace
}  // namespace dismantle::checks
