// Statics of the samples whose answers are known.
#include "dismantle/samples/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dismantle/statics/stability.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::statics {
namespace {

constexpr double kDegrees = M_PI / 180;

struct Case {
  Case(const std::string& sample, const ParamSet& params, StabilityOptions options, const std::string& without = "")
      : assembly(assembly_of(sample, params, options, without)), pile(assembly, std::move(options)) {}
  static Assembly assembly_of(const std::string& sample, const ParamSet& params, StabilityOptions& options,
                              const std::string& without) {
    const samples::Model model = samples::make_model(sample, params);
    std::vector<Mesh> meshes;
    for (const RawPart& part : model.parts)
      if (part.name != without) {
        meshes.push_back(part.mesh);
        options.fixed.push_back(part.name == "ground" || part.name == "channel");
      }
    return shapes::assembly_of(meshes);
  }
  Verdict verdict() const { return judge(pile.pile()).verdict; }
  Assembly assembly;
  AssemblyPile pile;
};

TEST(SamplesStand, AStackUpToTheHarmonicSeries) {
  for (const std::int64_t blocks : {2, 3, 5, 8})
    for (const double shift : {0.0, 0.5, 0.9}) {
      const Case stack("stack", {{"blocks", blocks}, {"shift", shift}}, {});
      EXPECT_EQ(stack.verdict(), Verdict::stands) << blocks << " " << shift;
    }
}

// A stack in line topples at the angle of its diagonal, unless it slides first.
TEST(SamplesStand, AStackTopplesOrSlides) {
  for (const double friction : {0.2, 0.4, 0.8}) {
    StabilityOptions options;
    options.friction = friction;
    const Case stack("stack", {{"blocks", std::int64_t{4}}, {"width", 20.0}, {"height", 10.0}}, options);
    const auto tilt = critical_tilt(stack.pile.pile(), Eigen::Vector3d::UnitY());
    ASSERT_TRUE(tilt);
    EXPECT_NEAR(*tilt / kDegrees, std::min(std::atan(20.0 / 40), std::atan(friction)) / kDegrees, 0.3);
  }
}

TEST(SamplesStand, ADomeWithEnoughFriction) {
  for (const std::int64_t rings : {1, 2, 3}) {
    StabilityOptions options;
    options.friction = 0.5;
    EXPECT_EQ(Case("dome", {{"rings", rings}}, options).verdict(), Verdict::stands) << rings;
    options.friction = 0.05;
    EXPECT_EQ(Case("dome", {{"rings", rings}}, options).verdict(), Verdict::falls) << rings;
  }
}

TEST(SamplesStand, ATableOnFourLegs) { EXPECT_EQ(Case("loose_table", {}, {}).verdict(), Verdict::stands); }

TEST(SamplesStand, ABlockBetweenWallsOnlyIfItWasPressedIn) {
  StabilityOptions options;
  options.table = false;
  EXPECT_EQ(Case("wedged_block", {}, options).verdict(), Verdict::pressed_in);
  options.friction = 0;
  EXPECT_EQ(Case("wedged_block", {}, options).verdict(), Verdict::falls);
}

TEST(SamplesStand, AnArchIfItIsThickEnoughAndWhole) {
  StabilityOptions options;
  options.friction = 0.8;
  options.table = false;
  for (const std::int64_t n : {7, 9, 15}) {
    const auto arch = [&](double thickness, const std::string& without = "") {
      return Case("arch", {{"voussoirs", n}, {"thickness", thickness}}, options, without).verdict();
    };
    EXPECT_EQ(arch(25), Verdict::stands) << n;
    EXPECT_EQ(arch(6), Verdict::falls) << n;
    EXPECT_EQ(arch(25, "voussoir" + std::to_string((n + 1) / 2)), Verdict::falls) << n;
  }
}

}  // namespace
}  // namespace dismantle::statics
