#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "gravity.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

/// Two bodies with lugs under each other, which make each stand while the other does not move. `floor`: below the lugs
/// of the second one.
struct Lugs {
  explicit Lugs(bool floor) {
    std::vector<Mesh> meshes{shapes::box({-1, -1, -2}, {0, 3, 3}),      shapes::box({4, -1, -2}, {5, 3, 3}),
                             shapes::box({0, 0, 0}, {2, 2, 1}),         shapes::box({2.2, 0.7, -0.3}, {3.8, 1.3, 0}),
                             shapes::box({2, 0, 0}, {4, 2, 1}),         shapes::box({0.2, 0, -0.3}, {1.8, 0.6, 0}),
                             shapes::box({0.2, 1.4, -0.3}, {1.8, 2, 0})};
    if (floor) meshes.push_back(shapes::box({0, 0, -1}, {4, 2, -0.3}));
    assembly = shapes::assembly_of(meshes);
    for (const PartId p : {2U, 3U}) assembly.parts[p].unit = 2;
    for (const PartId p : {4U, 5U, 6U}) assembly.parts[p].unit = 4;
    for (PartId p = 0; p < meshes.size(); ++p) (p == 4 || p == 5 || p == 6 ? moving : present).push_back({p, Pose{}});
  }
  std::size_t held_after() const {
    const std::string fixed = assembly.parts[0].name + "," + assembly.parts[1].name + ",part7";
    const StepVerdict verdict =
        Gravity({.fixed = fixed, .friction = 0.4}).judge({assembly, moving, present, -Vector3d::UnitZ()}, RunContext{});
    std::size_t after = 0;
    for (const StepNote& note : verdict.notes) {
      const nlohmann::json data = nlohmann::json::parse(note.data);
      for (const auto& hold : data.at("hold")) after += hold.at("when") == "after" ? 1 : 0;
    }
    return after;
  }
  Assembly assembly;
  std::vector<PlacedPart> present, moving;
};

// Between two walls, with nothing below, somebody must have pressed them in: one of the two is held.
TEST(Wedged, BodiesThatOnlyCarryEachOtherAreHeld) {
  EXPECT_EQ(Lugs(false).held_after(), 1u);
  EXPECT_EQ(Lugs(true).held_after(), 0u);
}

}  // namespace
}  // namespace dismantle::checks
