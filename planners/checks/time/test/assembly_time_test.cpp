#include "assembly_time.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

/// The first mesh is put in, along -z; the others are there. Millimetres.
struct Step {
  explicit Step(std::vector<Mesh> meshes) : assembly(shapes::assembly_of(meshes)) {
    for (PartId id = 1; id < assembly.parts.size(); ++id) present.push_back({id, Pose{}});
  }
  StepVerdict verdict(const Vector3d& direction = -Vector3d::UnitZ(), const StepQuestion* previous = nullptr,
                      const TimeParameters& params = {}) const {
    StepQuestion question{assembly, moving, present, direction};
    question.previous = previous;
    return Time(params).judge(question, RunContext{});
  }
  Assembly assembly;
  std::vector<PlacedPart> moving{{0, Pose{}}}, present;
};

Mesh plate() { return shapes::box({-50, -50, -5}, {50, 50, 0}); }
Mesh cube() { return shapes::box({-10, -10, 0}, {10, 10, 20}); }

TEST(Time, ACubeOnAPlate) {
  const StepVerdict v = Step({cube(), plate()}).verdict();
  EXPECT_DOUBLE_EQ(v.cost, 1.13 + 1.5);
  ASSERT_EQ(v.notes.size(), 1u);
  EXPECT_EQ(v.notes[0].text, "About 2.6 s: 1.13 to take it up, 1.5 to put it in.");
  EXPECT_NE(v.notes[0].data.find("\"handling\":\"00\""), std::string::npos) << v.notes[0].data;
}

TEST(Time, TheMannerOfInsertionCounts) {
  Step s({cube(), plate()});
  EXPECT_DOUBLE_EQ(s.verdict(Vector3d::UnitZ()).cost, 1.13 + 5.5) << "from below";
  s.assembly.parts[0].kind = PartKind{"screw"};
  EXPECT_DOUBLE_EQ(s.verdict().cost, 1.13 + 6);
  s.assembly.parts[0].kind.reset();
  InitialOverlap press{0, 1, 0.01};
  press.place.emplace().contact = ContactClass::uniform_interference;
  s.assembly.overlaps.push_back(press);
  EXPECT_DOUBLE_EQ(s.verdict().cost, 1.13 + 5);
  const Step deep({cube(), plate(), shapes::box({15, -50, 0}, {20, 50, 60})});
  EXPECT_DOUBLE_EQ(deep.verdict().cost, 1.13 + 4) << "a wall beside it";
  const Step low({cube(), plate(), shapes::box({15, -50, 0}, {20, 50, 30})});
  EXPECT_DOUBLE_EQ(low.verdict().cost, 1.13 + 1.5);
}

TEST(Time, TurningTheWholeCounts) {
  const Step s({cube(), plate()});
  StepQuestion before{s.assembly, s.moving, {}, -Vector3d::UnitZ()};
  EXPECT_DOUBLE_EQ(s.verdict(-Vector3d::UnitZ(), &before).cost, 1.13 + 1.5);
  before.up = Vector3d::UnitX();
  EXPECT_DOUBLE_EQ(s.verdict(-Vector3d::UnitZ(), &before).cost, 1.13 + 1.5 + 9);
}

// Law: the seconds are the same in any unit that the file states, and however the whole is
// turned by quarters.
TEST(Time, DoesNotDependOnUnitOrPlace) {
  Rng rng(2);
  for (const auto& [unit, mm] : {std::pair("mm", 1.0), {"inch", 25.4}, {"m", 1000.0}, {"", 1.0}})
    for (int k = 0; k < 5; ++k) {
      const Pose pose{shapes::random_vector(rng, -100, 100),
                      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2 * static_cast<double>(rng.below(4)),
                                                           Vector3d::Unit(static_cast<int>(rng.below(3)))))};
      const double scale = rng.uniform(0.01, 3);  // assembly units of a millimetre
      std::vector<Mesh> meshes{cube(), plate()};
      for (Mesh& m : meshes) {
        m = shapes::moved(m, pose);
        for (auto& v : m.vertices) v *= scale;
      }
      Step s(meshes);
      s.assembly.unit = unit;
      s.assembly.normalization.scale = scale * mm;
      EXPECT_DOUBLE_EQ(s.verdict(pose.q * -Vector3d::UnitZ()).cost,
                       (pose.q * -Vector3d::UnitZ()).z() > 0.7 ? 1.13 + 5.5 : 1.13 + 1.5);
    }
}

// Law: the symmetry of a prism with n corners about its axis is 360 / n, at any pose; a cap makes both ends differ.
TEST(Time, SymmetryOfPrisms) {
  Rng rng(7);
  for (const int n : {3, 4, 5, 6, 8, 64}) {
    const Pose pose = shapes::random_pose(rng, 3);
    const Vector3d axis = pose.q * Vector3d::UnitZ();
    const Mesh prism = shapes::tube(0, 1, 0, 3, n);
    const Symmetry s = symmetry_of(shapes::moved(prism, pose), axis);
    EXPECT_EQ(s.beta, n == 64 ? 0 : 360.0 / n) << n;
    EXPECT_EQ(s.alpha, 180) << n;
    const Mesh capped = shapes::joined(prism, shapes::tube(0, 2, 3, 3.5, n));
    EXPECT_EQ(symmetry_of(shapes::moved(capped, pose), axis).alpha, 360) << n;
  }
  const Mesh ball = shapes::sphere({1, 2, 3}, 2, 4);
  EXPECT_EQ(symmetry_of(ball, Vector3d::UnitX()).alpha, 0);
  const Mesh wedge = shapes::joined(shapes::box({0, 0, 0}, {5, 2, 1}), shapes::box({0, 0, 1}, {1, 1, 3}));
  EXPECT_EQ(symmetry_of(wedge, Vector3d::UnitZ()).alpha, 360);
  EXPECT_EQ(symmetry_of(wedge, Vector3d::UnitZ()).beta, 360);
}

TEST(Time, ATableOfTheUserReplacesBothTimes) {
  Step s({cube(), plate()});
  s.assembly.parts[0].kind = PartKind{"screw"};
  EXPECT_EQ(s.verdict(-Vector3d::UnitZ(), nullptr, {"screw=12.5, part*=7"}).cost, 12.5);
  EXPECT_EQ(s.verdict(-Vector3d::UnitZ(), nullptr, {"part? = 7,screw=12.5"}).cost, 7);
  EXPECT_DOUBLE_EQ(s.verdict(-Vector3d::UnitZ(), nullptr, {"nut=9"}).cost, 1.13 + 6);
  const StepVerdict free = s.verdict(-Vector3d::UnitZ(), nullptr, {"screw=0"});
  EXPECT_EQ(free.cost, 0);
  EXPECT_EQ(free.reason, "");
  for (const char* bad : {"screw", "=3", "screw=", "screw=-1", "screw=3 s", "screw=nan"})
    EXPECT_THROW(Time({bad}), std::invalid_argument) << bad;
}

// Law: the plan costs nothing by itself, and its note has the sum of the steps; the estimate is never less.
TEST(Time, ThePlanSaysTheSum) {
  const Step s({cube(), plate()});
  const std::vector<StepQuestion> operations(30, StepQuestion{s.assembly, s.moving, s.present, -Vector3d::UnitZ()});
  const StepVerdict v = Time().judge_plan(operations, RunContext{});
  EXPECT_EQ(v.cost, 0);
  ASSERT_EQ(v.notes.size(), 1u);
  EXPECT_NE(v.notes[0].text.find("about 1 min 19 s for 30 steps"), std::string::npos) << v.notes[0].text;
  EXPECT_GE(Time().estimate(operations[0], RunContext{}).cost, Time().judge(operations[0], RunContext{}).cost);
  EXPECT_TRUE(Time().judge_plan({}, RunContext{}).notes.empty());
}

}  // namespace
}  // namespace dismantle::checks
