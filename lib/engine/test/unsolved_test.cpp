// What the plan says of parts that are left: the attempts, and where they touch others at their best pose.
#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// Each moving part touches every fixed part twice, the second time deeper; places depend on where the part is.
class TouchingWorld final : public World {
 public:
  explicit TouchingWorld(Scene scene) : scene_(std::move(scene)) {}
  const Scene& scene() const override { return scene_; }
  MotionSpace space() const override { return MotionSpace::rigid; }
  State initial_state() const override {
    State state;
    for (const auto& p : scene_.moving) state.bodies.push_back({p.pose});
    return state;
  }
  Eigen::Vector3d center(std::size_t) const override { return Eigen::Vector3d::Zero(); }
  double radius(std::size_t) const override { return 1; }
  double torque_arm(std::size_t) const override { return 1; }
  StepReport advance(State&, const Action&, double, Trace*) override { return {}; }
  double penetration(const State&) override { return 0; }
  void contacts(const State& state, std::vector<Contact>& out) override {
    out.clear();
    for (const auto& fixed : scene_.fixed)
      for (const double depth : {0.1, 0.2}) {
        Contact c;
        c.moving = scene_.moving[0].part;
        c.other = fixed.part;
        c.point = state.bodies[0].pose.t + Eigen::Vector3d(fixed.part, depth, 0);
        c.depth = depth;
        out.push_back(c);
      }
  }
  bool separated(const State&) override { return false; }
  void add_contact_sample(PartId, PartId, const Eigen::Vector3d&) override {}

 private:
  Scene scene_;
};

class TouchingPhysics final : public Simulator {
 public:
  Capabilities capabilities() const noexcept override { return {true, true, true, 4}; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly&, double, RunContext&) override {
    return std::make_shared<PreparedAssembly>();
  }
  std::unique_ptr<World> world(const Assembly&, const PreparedAssembly&, const Scene& scene,
                               MotionSpace) const override {
    return std::make_unique<TouchingWorld>(scene);
  }
};

const Eigen::Vector3d kReached(0, 0, 3);

PathResult never(const PathQuery& query, RunContext&) {
  PathResult result = PathResult::failure(Outcome::depth_limit, "no");
  result.depth = 1;
  result.blocked_by = {query.scene.fixed.front().part};
  result.best_pose.assign(query.scene.moving.size(), Pose{kReached, Eigen::Quaterniond::Identity()});
  return result;
}

/// Asks for every part at depths 1 to `rounds`, and once more for the last.
RunResult tried(Assembly assembly, unsigned rounds, bool with_contacts) {
  const auto steps = [rounds](const Assembly& a, PathOracle& oracle, SequenceObserver&, RunContext& context) {
    SequenceResult result;
    result.outcome = Outcome::depth_limit;
    for (const auto& part : a.parts) {
      const AttemptResult* last = nullptr;
      for (unsigned depth = 1; depth <= rounds; ++depth) {
        Attempt attempt = fake::leave(a, part.id);
        attempt.max_depth = depth;
        last = &oracle.attempt(attempt, context);
        last = &oracle.attempt(attempt, context);  // from memory: no search
      }
      result.remaining.push_back(part.id);
      result.unsolved.push_back(
          {part.id, last->result.outcome(), last->result.blocked_by, last->result.best_pose, last->result.message});
    }
    return result;
  };
  PlanningSetup parts = fake::setup(never, std::make_shared<fake::Custom>(steps));
  if (with_contacts) parts.simulator = std::make_shared<TouchingPhysics>();
  RunContext context;
  return run(assembly, parts, RunOptions{}, context);
}

TEST(Unsolved, SearchesAreCountedAndPlacesAreInInputUnits) {
  Assembly assembly = fake::tube_with_blocks(2);
  assembly.normalization.scale = 0.5;  // an input unit is half an internal one
  assembly.normalization.center = {100, 0, 0};
  for (const unsigned rounds : {1u, 4u}) {
    const Plan plan = tried(assembly, rounds, true).plan;
    ASSERT_EQ(plan.unsolved.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanUnsolved& u = plan.unsolved[i];
      EXPECT_EQ(u.planner, "scripted");
      EXPECT_EQ(u.attempts, rounds);
      EXPECT_EQ(u.depth, rounds);
      EXPECT_GE(u.seconds, 0);
      ASSERT_EQ(u.places.size(), 2u) << "one for each of the others";
      for (const PlanPlace& place : u.places) {
        const auto other = std::ranges::find(assembly.parts, place.part, &Part::name);
        ASSERT_NE(other, assembly.parts.end());
        EXPECT_NE(other->id, i);
        const Eigen::Vector3d deepest = kReached + Eigen::Vector3d(other->id, 0.2, 0);
        EXPECT_LT((place.at - (deepest / 0.5 + Eigen::Vector3d(100, 0, 0))).norm(), 1e-12);
      }
    }
  }
}

TEST(Unsolved, ASimulatorThatFailsCostsThePlacesOnly) {
  const Plan plan = tried(fake::tube_with_blocks(2), 1, false).plan;  // its worlds throw
  ASSERT_EQ(plan.unsolved.size(), 3u);
  for (const PlanUnsolved& u : plan.unsolved) {
    EXPECT_EQ(u.attempts, 1u);
    EXPECT_TRUE(u.places.empty());
  }
}

TEST(Unsolved, ThePlanBeforeTheFirstStepHasEveryPart) {
  const Assembly assembly = fake::tube_with_blocks(3);
  const Plan plan = plan_of(Disassembly(assembly.parts.size()), assembly, RunOptions{});
  EXPECT_EQ(plan.status, PlanStatus::partial);
  EXPECT_TRUE(plan.disassembly.empty());
  EXPECT_EQ(plan.remaining.size(), assembly.parts.size());
  EXPECT_EQ(plan.assembly.parts.size(), assembly.parts.size());
}

}  // namespace
}  // namespace dismantle
