// A path planner in one file: pushes the part along each axis until it is out.
#include <array>

#include "dismantle/plugin.h"

namespace {

struct StraightParameters {
  double force = 100;
  double push_time = 0.1;
  std::int64_t max_pushes = 200;

  static void describe(dismantle::Schema<StraightParameters>& s) {
    s.add("force", &StraightParameters::force,
          {.unit = "mass * assembly units / s^2", .min = 0, .min_open = true, .doc = "Force of a push."});
    s.add("push_time", &StraightParameters::push_time,
          {.unit = "s", .min = 0, .min_open = true, .doc = "Length of a push."});
    s.add("max_pushes", &StraightParameters::max_pushes, {.unit = "1", .min = 1, .doc = "Pushes per direction."});
  }
};

constexpr dismantle::Capabilities kNeeds{.dynamics = true};

class Straight final : public dismantle::FunctionPathPlanner {
 public:
  explicit Straight(const StraightParameters& params) : params_(params) {}

  dismantle::PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds}; }

  dismantle::PathResult plan(const dismantle::PathQuery& query, dismantle::RunContext& context) override {
    if (!query.simulator.capabilities().dynamics)
      return dismantle::PathResult::failure(dismantle::Outcome::unsupported,
                                            "the simulator has no dynamics to push with");
    const auto world =
        query.simulator.world(query.assembly, query.prepared, query.scene, dismantle::MotionSpace::translation);
    const dismantle::State start = world->initial_state();
    dismantle::PathResult result;
    if (world->separated(start)) {
      result.start_is_goal();
      return result;
    }
    const auto deadline = query.budget.timeout > 0
                              ? context.deadline.earlier(dismantle::Deadline::after_seconds(query.budget.timeout))
                              : context.deadline;
    result.fail(dismantle::Outcome::exhausted);
    for (int direction = 0; direction < 6; ++direction) {
      Eigen::Vector3d force = Eigen::Vector3d::Zero();
      force[direction / 2] = direction % 2 == 0 ? params_.force : -params_.force;
      const dismantle::Action push{
          std::vector<dismantle::Wrench>(start.bodies.size(), {force, Eigen::Vector3d::Zero()})};

      dismantle::State state = start;
      dismantle::Path path = {poses(start)};
      for (std::int64_t n = 0; n < params_.max_pushes; ++n) {
        const bool spent = query.budget.max_steps > 0 && result.stats.steps >= query.budget.max_steps;
        if (context.cancel.cancelled() || deadline.passed() || spent) {
          result.fail(context.cancel.cancelled() ? dismantle::Outcome::cancelled : dismantle::Outcome::timeout);
          return result;
        }
        const dismantle::StepReport report = world->advance(state, push, params_.push_time, &path);
        result.stats.steps += report.steps;
        result.stats.cost = static_cast<double>(result.stats.steps);
        if (world->separated(state)) {
          const dismantle::PathCheck check = query.checker.check(path);
          if (!check.accepted()) break;  // the verifier saw a collision: not in this direction
          result.solve(*check.verified, 1);
          return result;
        }
        if (report.stalled || !report.finite) break;
      }
    }
    return result;
  }

 private:
  static std::vector<dismantle::Pose> poses(const dismantle::State& state) {
    std::vector<dismantle::Pose> all;
    for (const auto& body : state.bodies) all.push_back(body.pose);
    return all;
  }

  StraightParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.straight", "1.0.0", "MIT", "https://example.org/straight") {
  r.add<dismantle::PathPlanner, Straight, StraightParameters>(
      "acme.straight", "Straight pushes along the six axes.",
      {.source = "the simplest thing that works", .needs = kNeeds});
}
