// The distance of a step is that in which others lead the part, however far its hull has to go.
#include "dismantle/plan_io/travel.h"

#include <gtest/gtest.h>

#include <random>

#include "dismantle/testing/shapes.h"
#include "random_disassembly.h"

namespace dismantle {
namespace {

/// A plate of thickness 2 with a hole of 2.1 x 2.1 and a wall of height 9 at one side, a pin of 2 x 2 x 5 in the hole,
/// and a lid that lies on the wall.
Assembly plate_and_pin(double scale) {
  Assembly a;
  a.normalization = {scale, {1, 2, 3}};
  const auto add = [&](const char* name, std::initializer_list<Aabb> boxes) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = name;
    Mesh mesh;
    for (const Aabb& box : boxes) {
      const Mesh one = shapes::box(box.lo, box.hi);
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& v : one.vertices) {
        a.input_box.extend(v);
        mesh.vertices.push_back(a.normalization.scale * (v - a.normalization.center));
      }
      for (auto t : one.triangles) {
        for (auto& corner : t) corner += first;
        mesh.triangles.push_back(t);
      }
    }
    part.mesh = part.surface = std::make_shared<Mesh>(std::move(mesh));
    a.parts.push_back(part);
  };
  add("plate", {{{-8, -8, 0}, {-1.05, 8, 2}},
                {{1.05, -8, 0}, {8, 8, 2}},
                {{-1.05, -8, 0}, {1.05, -1.05, 2}},
                {{-1.05, 1.05, 0}, {1.05, 8, 2}},
                {{-8, -8, 2}, {-7, 8, 9}}});
  add("pin", {{{-1, -1, 0.5}, {1, 1, 5.5}}});
  add("lid", {{{-8, -8, 9}, {-2, 8, 10}}});
  return a;
}

Plan plan_of(const Assembly& a) {
  Plan plan;
  plan.assembly.box = a.input_box;
  for (const Part& part : a.parts) plan.assembly.parts.push_back({part.id, part.name, "a.stl"});
  const auto leaves = [&](const std::string& name, const Eigen::Vector3d& by) {
    PlanStep step;
    step.step = static_cast<unsigned>(plan.disassembly.size()) + 1;
    step.moves = {{name, {Pose{}, Pose{by, Eigen::Quaterniond::Identity()}}}};
    step.separates = {{name}};
    plan.disassembly.push_back(step);
  };
  leaves("lid", {0, 0, 0.013});
  leaves("pin", {0, 0, 8.6});
  return plan;
}

TEST(Travel, APinIsLedByItsHoleAndALidRests) {
  for (const double scale : {0.1, 1.0, 3.0}) {
    const Assembly a = plate_and_pin(scale);
    const auto distances = guided_distances(plan_of(a), a);
    ASSERT_EQ(distances.size(), 2u);
    EXPECT_NEAR(distances[0].value(), 0, 1e-9);
    EXPECT_NEAR(distances[1].value(), 1.5, 1e-9)
        << "from the rear end of the pin to the rim of the hole, not to the wall";
  }
}

TEST(Travel, DoesNotDependOnHowTheAssemblyLies) {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  const Assembly a = plate_and_pin(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose lies{{any(random), any(random), any(random)},
                    Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized()};
    const double distance = guided_distance(a, {{1, lies}}, {{0, lies}, {2, lies}}, lies.q * Eigen::Vector3d(0, 0, 5));
    EXPECT_NEAR(distance, 1.5, 1e-9);
  }
}

TEST(Travel, IsNeverLongerThanThePathAndNoneWhereThePathIsNotStraight) {
  const Assembly a = plate_and_pin(1);
  Plan plan = plan_of(a);
  plan.disassembly[1].moves[0].poses.back().t.z() = 1.2;
  EXPECT_NEAR(guided_distances(plan, a)[1].value(), 1.2, 1e-9);
  plan.disassembly[1].moves[0].poses.push_back({{5, 0, 1.2}, Eigen::Quaterniond::Identity()});
  EXPECT_FALSE(guided_distances(plan, a)[1]);
  plan.disassembly[1].moves[0].poses = {Pose{}, Pose{{0, 0, 3}, Eigen::Quaterniond(0.8, 0, 0, 0.6)}};
  EXPECT_FALSE(guided_distances(plan, a)[1]) << "a screw turns all the way";
  plan.disassembly[0].separates.clear();
  EXPECT_FALSE(guided_distances(plan, a)[0]) << "where it is shifted to matters";
}

TEST(Travel, WordsSayWhatIsSeen) {
  const MotionSummary motion =
      summarize_motion({Pose{}, Pose{{0, 0, -4}, Eigen::Quaterniond::Identity()}}, {0, 0, 0}, 0.1);
  const MotionPhrase together{{"mm", 25.4}, Eigen::Vector3d::UnitZ(), 10, false},
      apart{{"mm", 25.4}, Eigen::Vector3d::UnitZ(), 10, true};
  const auto upright = Eigen::Quaterniond::Identity();
  EXPECT_EQ(travel_words(motion, 2.0, together, upright), "50.8 mm down (-Z)");
  EXPECT_EQ(travel_words(motion, 0.0, together, upright), "down (-Z), until it seats");
  EXPECT_EQ(travel_words(motion, 0.0, apart, upright), "down (-Z), free at once");
  EXPECT_EQ(travel_words(motion, std::nullopt, together, upright), "102 mm down (-Z)");
}

}  // namespace
}  // namespace dismantle
