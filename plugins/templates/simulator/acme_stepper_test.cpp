// Tests of acme.stepper beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include "dismantle/host/registry.h"
#include "dismantle/testing/fake_planning.h"

namespace {

using Eigen::Vector3d;

/// A plate in a closed box, and helpers that move it.
class AcmeStepper : public testing::Test {
 protected:
  AcmeStepper() : assembly_(dismantle::fake::closed_box()) {
    registry_.load(PLUGIN_FILE);
    simulator_ = registry_.create<dismantle::Simulator>("acme.stepper", {{"speed", 2.0}, {"time_step", 0.01}});
    dismantle::RunContext context;
    prepared_ = simulator_->prepare(assembly_, 0.01, context);
    world_ = simulator_->world(assembly_, *prepared_, {{{1, dismantle::Pose{}}}, {{0, dismantle::Pose{}}}},
                               dismantle::MotionSpace::rigid);
  }
  static dismantle::Action push(const Vector3d& force) { return {{{force, Vector3d::Zero()}}}; }

  dismantle::Registry registry_;
  dismantle::Assembly assembly_;
  std::shared_ptr<dismantle::Simulator> simulator_;
  std::shared_ptr<const dismantle::PreparedAssembly> prepared_;
  std::unique_ptr<dismantle::World> world_;
};

TEST_F(AcmeStepper, MovesWithItsSpeedWhateverTheForce) {
  dismantle::Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d force(rng.normal(), rng.normal(), rng.normal());
    dismantle::State state = world_->initial_state();
    const auto report = world_->advance(state, push(force), 0.2);
    EXPECT_FALSE(report.stalled);
    EXPECT_NEAR((state.bodies[0].pose.t - 0.4 * force.normalized()).norm(), 0, 1e-12);
  }
}

TEST_F(AcmeStepper, StopsAtTheWallOfTheBox) {
  for (int axis = 0; axis < 3; ++axis) {
    dismantle::State state = world_->initial_state();
    const auto report = world_->advance(state, push(Vector3d::Unit(axis)), 10);
    EXPECT_TRUE(report.stalled);
    const double room = axis == 2 ? 1.8 : 0.9;  // from the plate to the wall
    EXPECT_NEAR(state.bodies[0].pose.t[axis], room, 0.021);
  }
}

}  // namespace
