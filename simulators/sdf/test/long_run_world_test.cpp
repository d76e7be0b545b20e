// Laws that hold after very many steps.
#include <cmath>

#include "dismantle/testing/trials.h"
#include "world_scene.h"

namespace dismantle::sdf {
namespace {

using namespace test;

Vector3d random_push(Rng& rng, double size) { return size * Vector3d(rng.normal(), rng.normal(), rng.normal()); }

bool same_bits(const State& a, const State& b) {
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    if (!(a.bodies[i].pose == b.bodies[i].pose) || a.bodies[i].velocity != b.bodies[i].velocity ||
        a.bodies[i].angular_velocity != b.bodies[i].angular_velocity)
      return false;
  return true;
}

class LongRun : public testing::TestWithParam<std::string> {};

/// A cube is pushed around in a closed room with clearance: it never gets out, nor deeper into a wall than at first.
TEST_P(LongRun, StuckPartsStayPut) {
  const double play = 0.02;
  const TestScene scene(
      GetParam(),
      {box(Vector3d::Constant(-0.5 + play), Vector3d::Constant(0.5 - play)), closed_room(Vector3d::Constant(0.5), 0.2)},
      {});
  const auto steps = static_cast<std::uint64_t>(testing_support::trials(100'000, 1'000'000));
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    const auto world = scene.world({0}, space);
    State s = world->initial_state();
    Rng rng(21);
    double deepest = 0, furthest = 0;
    std::uint64_t done = 0;
    while (done < steps / 2) {
      const StepReport report = world->advance(
          s, push(random_push(rng, 100), space == MotionSpace::rigid ? random_push(rng, 20) : Vector3d::Zero()), 0.1);
      ASSERT_TRUE(report.finite);
      done += std::max<std::uint64_t>(1, report.steps);
      deepest = std::max(deepest, world->penetration(s));
      furthest = std::max(furthest, displacement(*world, s).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(deepest, 0.005);
    EXPECT_LT(furthest, play + 0.005);
    EXPECT_GT(furthest, 0.5 * play) << "it did move";
    EXPECT_FALSE(world->separated(s));
    EXPECT_NEAR(s.bodies[0].pose.q.norm(), 1, 1e-9);
  }
}

/// A long path is reproducible: repeating its actions from any of its states, in a world with another history, gives
/// bitwise the same states; and the trace equals the states.
TEST_P(LongRun, APathIsWhatItsActionsLeadTo) {
  const Mesh rail = box(Vector3d(-60, -0.5, -1), Vector3d(60, 0.5, 0));
  const TestScene scene(GetParam(), {box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), rail}, {});
  const int count = testing_support::trials(1000, 20'000);
  const auto world = scene.world({0}, MotionSpace::rigid);
  Rng rng(22);
  std::vector<Action> actions;
  std::vector<State> states{world->initial_state()};
  Trace trace;
  for (int k = 0; k < count; ++k) {
    actions.push_back(push(random_push(rng, 60) - Vector3d(0, 0, 60), random_push(rng, 5)));
    State s = states.back();
    ASSERT_TRUE(world->advance(s, actions.back(), 0.02, &trace).finite);
    ASSERT_TRUE(trace.empty() || trace.back()[0] == s.bodies[0].pose);
    states.push_back(std::move(s));
  }
  const auto other = scene.world({0}, MotionSpace::rigid);
  for (int piece = 0; piece < 10; ++piece) {
    State elsewhere = at(*other, shift(rng.uniform(-1, 1), 0, rng.uniform(0, 1)));
    other->advance(elsewhere, push(random_push(rng, 100)), 0.1);
    const std::size_t from = piece == 0 ? 0 : rng.below(static_cast<std::uint64_t>(count));
    State s = states[from];
    for (std::size_t k = from; k < actions.size() && k < from + 300; ++k) {
      other->advance(s, actions[k], 0.02);
      ASSERT_TRUE(same_bits(s, states[k + 1])) << "action " << k << " from " << from;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Simulators, LongRun, testing::Values("sdf_penalty", "sdf_velocity"));

/// Without forces, a cube thrown around in a room loses energy at the walls and gains none: backward Euler damps for
/// any stiffness and step length. A body that rotates in contact may gain a little in one step, since contact is
/// linearised; the gains do not add up.
TEST(PenaltyEnergy, OfMotionIsBounded) {
  Rng rng(23);
  const int trials = testing_support::trials(12, 200);
  for (const char* dynamics : {"unit_mass", "density", "acceleration"})
    for (int trial = 0; trial < trials; ++trial) {
      SCOPED_TRACE(std::string(dynamics) + ", trial " + std::to_string(trial));
      const double stiffness = std::pow(10.0, rng.uniform(4, 8)), step = std::pow(10.0, rng.uniform(-4, -2));
      const TestScene scene(
          "sdf_penalty",
          {box(Vector3d::Constant(-0.3), Vector3d::Constant(0.3)), closed_room(Vector3d::Constant(0.5), 0.3)},
          {{"dynamics", std::string(dynamics)},
           {"contact_stiffness", stiffness},
           {"contact_damping", trial % 2 == 0 ? 0.0 : rng.uniform(0, 100)},
           {"time_step", step},
           {"max_travel", 0.05}});
      const auto world = scene.world({0}, trial % 3 == 0 ? MotionSpace::translation : MotionSpace::rigid);
      State s = world->initial_state();
      // In the room nothing moves further than max_travel in a step.
      const double fast = 0.3 * 0.05 / step;
      s.bodies[0].velocity = fast * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      if (world->space() == MotionSpace::rigid)
        s.bodies[0].angular_velocity = fast * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      // Kinetic energy per unit of mass. A cube's inertia is a multiple of the identity: m a^2 / 6.
      const double arm = 0.6 * 0.6 / 6;
      const auto energy = [&] {
        return 0.5 * (s.bodies[0].velocity.squaredNorm() + arm * s.bodies[0].angular_velocity.squaredNorm());
      };
      const double first = energy();
      double most = 0;
      for (int k = 0; k < 300; ++k) {
        ASSERT_TRUE(world->advance(s, push(Vector3d::Zero()), step).finite);
        most = std::max(most, energy());
      }
      EXPECT_LE(most, 1.25 * first);
      EXPECT_LE(energy(), first * (1 + 1e-6));
    }
}

}  // namespace
}  // namespace dismantle::sdf
