// acme.lines: a path planner. Moves the parts along straight lines, in the directions of the axes and then in random
// ones, until a state collides or the parts are out; the verifier has the last word.
#include "dismantle/plugin.h"

namespace {

using Eigen::Vector3d;

struct AcmeLinesParameters {
  std::int64_t directions = 60;
  double step = 0.05;
  double share = 0.5;

  static void describe(dismantle::Schema<AcmeLinesParameters>& s) {
    s.add("directions", &AcmeLinesParameters::directions,
          {.unit = "1", .min = 6, .doc = "Directions that are tried: six along the axes, all others are random."});
    s.add("step", &AcmeLinesParameters::step,
          {.unit = "radii of the part",
           .min = 0,
           .max = 1,
           .min_open = true,
           .doc = "Distance between two states that are checked on a line."});
    s.add("share", &AcmeLinesParameters::share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc =
               "Share of the verifier's tolerance by which a state may penetrate; the rest is in reserve for what lies "
               "between two states."});
  }
};

constexpr dismantle::Capabilities kNeeds{.distance = true};

class AcmeLines final : public dismantle::FunctionPathPlanner {
 public:
  explicit AcmeLines(const AcmeLinesParameters& params) : params_(params) {}

  dismantle::PathPlannerTraits traits() const noexcept override { return {.needs = kNeeds, .concurrent = true}; }

  dismantle::PathResult plan(const dismantle::PathQuery& query, dismantle::RunContext& context) override {
    if (!query.simulator.capabilities().distance)
      return dismantle::PathResult::failure(dismantle::Outcome::unsupported,
                                            "the simulator does not tell free states from colliding ones");
    const auto world =
        query.simulator.world(query.assembly, query.prepared, query.scene, dismantle::MotionSpace::translation);
    const dismantle::State start = world->initial_state();
    dismantle::PathResult result;
    if (world->separated(start)) {
      result.start_is_goal();
      return result;
    }
    result.fail(dismantle::Outcome::exhausted, "none of the straight lines leads out");
    const double step = params_.step * world->radius(0);
    double& lines = result.stats.extra["lines"];  // a count of its own: a column of reports
    for (std::int64_t n = 0; n < params_.directions; ++n) {
      ++lines;
      const Vector3d direction = n < 6 ? (n % 2 == 0 ? 1 : -1) * Vector3d::Unit(n / 2) : random_direction(context.rng);
      for (std::int64_t k = 1;; ++k) {
        const bool spent = query.budget.max_steps > 0 && result.stats.state_checks >= query.budget.max_steps;
        if (context.should_stop() || spent) {
          result.fail(context.cancel.cancelled() ? dismantle::Outcome::cancelled : dismantle::Outcome::timeout);
          return result;
        }
        const dismantle::State state = moved(start, static_cast<double>(k) * step * direction);
        ++result.stats.state_checks;
        result.stats.cost = static_cast<double>(result.stats.state_checks);
        if (world->penetration(state) > params_.share * query.tolerance) break;
        if (!world->separated(state)) continue;
        const auto check = query.checker.check({poses(start), poses(state)});  // a line needs no poses between its ends
        if (check.accepted()) {
          result.solve(*check.verified, 1);
          return result;
        }
        ++result.stats.refused;
        break;
      }
    }
    return result;
  }

 private:
  static Vector3d random_direction(dismantle::Rng& rng) {
    const Vector3d v(rng.normal(), rng.normal(), rng.normal());
    return v.norm() > 0 ? Vector3d(v.normalized()) : Vector3d::UnitZ();
  }
  /// All moving parts together: they leave as one group.
  static dismantle::State moved(dismantle::State state, const Vector3d& by) {
    for (auto& body : state.bodies) body.pose.t += by;
    return state;
  }
  static std::vector<dismantle::Pose> poses(const dismantle::State& state) {
    std::vector<dismantle::Pose> all;
    for (const auto& body : state.bodies) all.push_back(body.pose);
    return all;
  }

  AcmeLinesParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.lines", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::PathPlanner, AcmeLines, AcmeLinesParameters>(
      "acme.lines", "Straight lines along the axes and in random directions.", {.source = "own", .needs = kNeeds});
}
