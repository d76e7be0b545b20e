// acme.first_of: a path planner that holds others, and asks them in their order until one finds a path.
#include <algorithm>

#include "dismantle/plugin.h"

namespace {

/// An item of the list: {type: ID, the parameters of that planner, steps: 1000}.
struct Member {
  dismantle::PluginRef<dismantle::PathPlanner> plugin;
  std::int64_t steps = 0;  // a key of ours beside them

  static void describe(dismantle::Schema<Member>& s) {
    s.add("steps", &Member::steps,
          {.unit = "1", .min = 0, .doc = "Time steps and state checks that it may make; 0 = no limit of its own."});
  }
};

struct FirstOfParameters {
  std::vector<Member> of;                                    // no default: the key has to be given
  dismantle::PluginRef<dismantle::PathPlanner> last{"bfs"};  // one planner, with a default

  static void describe(dismantle::Schema<FirstOfParameters>& s) {
    s.add("of", &FirstOfParameters::of, {.doc = "The planners, in the order in which they are asked."});
    s.add("last", &FirstOfParameters::last, {.doc = "Asked when all others have failed."});
  }
};

class FirstOf final : public dismantle::FunctionPathPlanner {
 public:
  explicit FirstOf(const FirstOfParameters& params) {
    for (const Member& member : params.of) add(member.plugin, static_cast<std::uint64_t>(member.steps));
    add(params.last, 0);
  }

  dismantle::PathPlannerTraits traits() const noexcept override { return {.needs = needs_}; }

  dismantle::PathResult plan(const dismantle::PathQuery& query, dismantle::RunContext& context) override {
    dismantle::PathResult result;
    std::uint64_t steps = 0, checks = 0;  // of all of them
    for (const Planner& planner : planners_) {
      dismantle::PathQuery part = query;  // refers to the same assembly, simulator and checker
      part.budget.max_steps = planner.steps;
      if (query.budget.max_steps > 0) {
        if (steps + checks >= query.budget.max_steps) break;
        const std::uint64_t left = query.budget.max_steps - steps - checks;
        part.budget.max_steps = planner.steps > 0 ? std::min(planner.steps, left) : left;
      }
      result = dismantle::plan_path(*planner.object, part, context);
      result.stats.steps = steps += result.stats.steps;
      result.stats.state_checks = checks += result.stats.state_checks;
      result.stats.cost = static_cast<double>(steps + checks);
      if (is_success(result.outcome()) || context.should_stop()) break;
    }
    return result;
  }

 private:
  struct Planner {
    std::shared_ptr<dismantle::PathPlanner> object;
    std::uint64_t steps = 0;
  };

  void add(const dismantle::PluginRef<dismantle::PathPlanner>& plugin, std::uint64_t steps) {
    planners_.push_back({plugin.create(), steps});
    const dismantle::Capabilities needs = planners_.back().object->traits().needs;
    needs_.dynamics = needs_.dynamics || needs.dynamics;
    needs_.contacts = needs_.contacts || needs.contacts;
    needs_.distance = needs_.distance || needs.distance;
  }

  std::vector<Planner> planners_;
  dismantle::Capabilities needs_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.first_of", "1.0.0", "MIT", "https://example.org/first_of") {
  r.add<dismantle::PathPlanner, FirstOf, FirstOfParameters>("acme.first_of", "Several planners, one after the other.",
                                                            {.source = "own"});
}
