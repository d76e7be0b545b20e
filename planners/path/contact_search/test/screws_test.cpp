// Screws and curved slides are removed for any orientation of the assembly, and the verifier accepts the paths.
#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/trials.h"
#include "table.h"

namespace dismantle::contact_search {
namespace {

/// The assembly as `dismantle plan` prepares it. Seed 0: as built; otherwise in a random orientation.
Assembly turned_sample(const std::string& name, ParamSet given, std::int64_t seed) {
  RunContext context;
  PrepareReport report;
  given["rotate_seed"] = seed;
  return prepare_assembly(samples::make(name, given), name, "", PrepareOptions{}, context, report);
}

/// The verifier has accepted the path already; here it checks the path that was returned.
void expect_solved(const Assembly& assembly, const std::string& name, std::uint64_t most_steps,
                   double tolerance = 0.01) {
  path::test::Table table(assembly, tolerance);
  const auto part =
      std::find_if(assembly.parts.begin(), assembly.parts.end(), [&](const Part& p) { return p.name == name; });
  ASSERT_NE(part, assembly.parts.end());
  const PathResult result = table.plan("contact_search", {}, 0, {.max_steps = most_steps}, {part->id});
  ASSERT_EQ(result.outcome(), Outcome::solved) << result.message;
  std::vector<PlacedPart> fixed;
  for (const Part& p : assembly.parts)
    if (p.id != part->id) fixed.push_back({p.id, Pose{}});
  EXPECT_TRUE(table.verifier.check_motion({part->id}, fixed, result.path()->poses()).valid);
  double turned = 0;
  for (std::size_t k = 1; k < result.path()->poses().size(); ++k)
    turned += angle_between(result.path()->poses()[k - 1][0].q, result.path()->poses()[k][0].q);
  EXPECT_GT(turned, 0.5) << "the path needs a rotation";
}

/// Simulated steps and state checks: several times as many as are needed.
constexpr std::uint64_t kSteps = 8'000;

void expect_solved_in_any_orientation(const std::string& name, const std::string& part, const ParamSet& given) {
  for (std::int64_t seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(name + ", " + std::to_string(seed));
    expect_solved(turned_sample(name, given, seed), part, kSteps);
  }
}

TEST(ContactSearchScrews, ANutIsUnscrewed) {
  expect_solved_in_any_orientation("bolt_and_nut", "nut",
                                   {{"turns", 1.0}, {"segments", std::int64_t{32}}, {"clearance", 0.12}});
}
/// Where the contacts at rest determine the screw of a thread, the nut is removed without simulated steps. Where they
/// do not, as with much clearance, the search finds the screw.
TEST(ContactSearchScrews, NutsOfAnySizeAreUnscrewed) {
  Rng rng(5);
  int without_simulation = 0;
  for (std::int64_t seed = 1; seed <= 6; ++seed) {
    const double diameter = rng.uniform(4, 20), pitch = diameter * rng.uniform(0.1, 0.24);
    SCOPED_TRACE(std::to_string(diameter) + " x " + std::to_string(pitch));
    path::test::Table table(turned_sample("bolt_and_nut",
                                          {{"diameter", diameter},
                                           {"pitch", pitch},
                                           {"turns", rng.uniform(0.5, 2)},
                                           {"clearance", pitch * rng.uniform(0.01, 0.06)},
                                           {"segments", std::int64_t{32}}},
                                          seed));
    const PathResult result = table.plan("contact_search", {}, 0, {.max_steps = kSteps}, {PartId{1}});
    EXPECT_EQ(result.outcome(), Outcome::solved) << result.message;
    without_simulation += is_success(result.outcome()) && result.stats.steps == 0 ? 1 : 0;
  }
  EXPECT_GT(without_simulation, 0);
}
/// The play of a fit does not depend on what the verifier tolerates.
TEST(ContactSearchScrews, AThreadComesOffAtAnyTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(tolerance);
    const ParamSet thread{{"turns", 1.0}, {"segments", std::int64_t{32}}, {"clearance", 0.12}};
    path::test::Table table(turned_sample("bolt_and_nut", thread, 1), tolerance);
    const PathResult result = table.plan("contact_search", {}, 0, {.max_steps = kSteps}, {PartId{1}});
    EXPECT_EQ(result.outcome(), Outcome::solved) << result.message;
  }
}
/// The ring slides round on what it touches, and cuts in by little more than a strict verifier allows. There is room.
TEST(ContactSearchScrews, ARingLeavesACurvedTubeAtAnyTolerance) {
  for (const double tolerance : {1e-3, 1e-4})
    for (std::int64_t seed = 1; seed <= testing_support::trials(1, 6); ++seed) {
      SCOPED_TRACE(::testing::Message() << tolerance << ", " << seed);
      expect_solved(turned_sample("ring_on_curved_tube", {}, seed), "ring", kSteps, tolerance);
    }
}

TEST(ContactSearchScrews, ARingLeavesACurvedTube) {
  expect_solved_in_any_orientation("ring_on_curved_tube", "ring", {{"segments", std::int64_t{24}}});
}

}  // namespace
}  // namespace dismantle::contact_search
