// Scenes with known answers, at random poses and in several units.
#include "dismantle/tools/access.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scene.h"

namespace dismantle::tools {
namespace {

using namespace test;
using std::numbers::pi;

/// Calls check(scene) for the scene at random poses in mm, m and inch.
template <class Check>
void everywhere(const std::vector<Mesh>& parts, const Fastener& fastener, const Check& check) {
  Rng rng(7);
  for (const double mm : {1.0, 1000.0, 25.4, 0.31})
    for (int k = 0; k < 3; ++k) check(Scene(parts, fastener, shapes::random_pose(rng, 100), mm));
}

/// A plate at the seat of the head, 200 mm wide, and a wall around a well of this radius, up to `top`.
std::vector<Mesh> well(double radius, double top) {
  return {shapes::box({-100, -100, -8}, {100, 100, -3.1}), shapes::tube(radius, radius + 90, -3, top, 96)};
}

TEST(FindAccess, OnlyALongKeyReachesTheGroundOfAWell) {
  everywhere(well(4, 40), m3(), [](const Scene& scene) {
    const Access key = scene.find(tool_named("hex_key_2.5"));
    ASSERT_TRUE(key.reaches());
    EXPECT_EQ(key.use->name, "long arm in the screw");
  });
  everywhere(well(4, 80), m3(), [](const Scene& scene) {
    const Access key = scene.find(tool_named("hex_key_2.5"));
    EXPECT_FALSE(key.reaches());
    EXPECT_EQ(key.obstacles, std::vector<std::size_t>{1});
    EXPECT_TRUE(scene.find(tool_named("hex_key_long_2.5")).reaches());
  });
}

TEST(FindAccess, OnlyAShortKeyReachesUnderARoof) {
  const std::vector<Mesh> parts{shapes::box({-200, -200, -8}, {200, 200, -3.1}),
                                shapes::box({-200, -200, 32}, {200, 200, 36})};
  everywhere(parts, m3(), [](const Scene& scene) {
    const Access key = scene.find(tool_named("hex_key_2.5"), false);
    ASSERT_TRUE(key.reaches());
    EXPECT_EQ(key.use->name, "short arm in the screw");
    EXPECT_FALSE(scene.find(tool_named("hex_driver_2.5"), false).reaches());
    EXPECT_EQ(scene.find(tool_named("hex_driver_2.5"), false).obstacles, std::vector<std::size_t>{1});
  });
}

TEST(FindAccess, TheHandNeedsRoomToo) {
  // 13 mm above the key's arm.
  const std::vector<Mesh> parts{shapes::box({-200, -200, 32}, {200, 200, 36})};
  everywhere(parts, m3(), [](const Scene& scene) {
    EXPECT_TRUE(scene.find(tool_named("hex_key_2.5"), false).reaches());
    const Access held = scene.find(tool_named("hex_key_2.5"), true);
    EXPECT_FALSE(held.reaches());
    EXPECT_EQ(held.obstacles, std::vector<std::size_t>{0});
  });
}

/// Two walls that leave a sector about +x, `opening` rad wide, for a handle that is `half` wide on each side.
std::vector<Mesh> sector(double opening, double half) {
  std::vector<Mesh> walls;
  for (const double side : {1.0, -1.0}) {
    // The handle turned to the edge of the sector lies along the wall's face.
    Mesh wall = shapes::box({10, half, -20}, {160, half + 20, 60});
    if (side < 0) wall = shapes::box({10, -half - 20, -20}, {160, -half, 60});
    walls.push_back(shapes::moved(wall, {Vec3::Zero(), rotation_from_vector({0, 0, side * opening / 2})}));
  }
  walls.push_back(shapes::box({-160, -160, -20}, {-9, 160, 60}));
  walls.push_back(shapes::box({-9, 12, -20}, {8, 160, 60}));
  walls.push_back(shapes::box({-9, -160, -20}, {8, -12, 60}));
  return walls;
}

TEST(FindAccess, AWrenchThatSwingsThirtyDegreesAndNotSixty) {
  Tool tool;
  tool.uses.resize(2);
  tool.uses[0].name = "60";
  tool.uses[0].swing = pi / 3;
  tool.uses[1].name = "30";
  tool.uses[1].swing = pi / 6;
  for (Use& use : tool.uses) use.tool = {box({6, -4}, {120, 4}, 0, 5)};
  for (const auto& [degrees, answer] : {std::pair{29.5, ""}, {30.5, "30"}, {45.0, "30"}, {59.5, "30"}, {60.5, "60"}})
    everywhere(sector(degrees * pi / 180, 4), m6_nut(), [&](const Scene& scene) {
      const Access access = scene.find(tool);
      EXPECT_EQ(access.reaches() ? access.use->name : "", answer) << degrees;
      // One of the two walls has to go.
      if (!access.reaches()) {
        EXPECT_EQ(access.obstacles.size(), 1u);
      }
    });
}

TEST(FindAccess, ANutNextToAWallIsForTheRingAndTheOpenEnd) {
  const std::vector<Mesh> parts{shapes::box({-200, -200, -15}, {200, 200, -5.2}),
                                shapes::box({-200, 12, -5}, {200, 30, 80})};
  everywhere(parts, m6_nut(), [](const Scene& scene) {
    const Access access = scene.find(tool_named("wrench_10"));
    ASSERT_TRUE(access.reaches());
    EXPECT_EQ(access.use->name, "ring");
  });
  // A stud stands far out of the nut: neither a socket nor a driver goes over it.
  const std::vector<Mesh> stud{shapes::tube(0, 3, -20, 60, 48)};
  everywhere(stud, m6_nut(), [](const Scene& scene) {
    EXPECT_FALSE(scene.find(tool_named("socket_10")).reaches());
    EXPECT_FALSE(scene.find(tool_named("deep_socket_10")).reaches());
    EXPECT_TRUE(scene.find(tool_named("wrench_10")).reaches());
  });
  const std::vector<Mesh> short_stud{shapes::tube(0, 3, -20, 2, 48)};
  everywhere(short_stud, m6_nut(),
             [](const Scene& scene) { EXPECT_TRUE(scene.find(tool_named("socket_10")).reaches()); });
}

TEST(FindAccess, ARingWithoutRoomForPliers) {
  Fastener ring;
  ring.kind = fasteners::Kind::ring;
  ring.size = 22, ring.radius = 11, ring.grip = 1;
  const Tool& pliers = tool_named("circlip_pliers");
  EXPECT_TRUE(fits(pliers, ring));
  everywhere({shapes::tube(0, 8, -30, 10, 64), shapes::tube(20, 60, -30, 0, 64)}, ring,
             [&](const Scene& scene) { EXPECT_TRUE(scene.find(pliers).reaches()); });
  // The ring lies deep in a bore.
  everywhere({shapes::tube(0, 8, -30, 10, 64), shapes::tube(14, 60, -30, 60, 64)}, ring, [&](const Scene& scene) {
    const Access access = scene.find(pliers);
    EXPECT_FALSE(access.reaches());
    EXPECT_EQ(access.obstacles, std::vector<std::size_t>{1});
  });
}

TEST(FindAccess, ATravelIsClearedAsAWhole) {
  // A bar 16 mm above the arm of the key: in the way of a screw that comes from 20 mm above its seat.
  const std::vector<Mesh> parts{shapes::tube(20, 40, 36, 40, 64)};
  Fastener screw = m3();
  everywhere(parts, screw,
             [](const Scene& scene) { EXPECT_TRUE(scene.find(tool_named("hex_key_2.5"), false).reaches()); });
  screw.travel = 20;
  Tool key = tool_named("hex_key_2.5");
  key.uses.resize(1);
  everywhere(parts, screw, [&](const Scene& scene) { EXPECT_FALSE(scene.find(key, false).reaches()); });
}

TEST(FindAccess, AToolInsideAPartIsNoRoom) {
  // No triangle is near; all around the screw is material.
  const std::vector<Mesh> parts{shapes::box({-500, -500, -500}, {500, 500, 500})};
  everywhere(parts, m3(), [](const Scene& scene) { EXPECT_FALSE(scene.find(tool_named("hex_key_2.5")).reaches()); });
}

TEST(FindAccess, NothingThereMeansRoomForEveryTool) {
  const Scene scene({}, m3());
  for (const Tool& tool : standard_catalogue()) {
    const Access access = scene.find(tool);
    EXPECT_TRUE(access.reaches()) << tool.id;
    EXPECT_EQ(access.use, &tool.uses.front());
    EXPECT_NEAR(access.handle.dot(scene.fastener().axis), 0, 1e-12);
  }
}

}  // namespace
}  // namespace dismantle::tools
