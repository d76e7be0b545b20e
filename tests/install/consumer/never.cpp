/// A path planner that gives up at once: the smallest plugin there can be.
#include <dismantle/plugin.h>

namespace {

struct NeverParams {
  double patience = 1;
  static void describe(dismantle::Schema<NeverParams>& s) {
    s.add("patience", &NeverParams::patience, {.unit = "s", .min = 0, .doc = "Not used up."});
  }
};

class Never : public dismantle::FunctionPathPlanner {
 public:
  explicit Never(const NeverParams&) {}
  dismantle::PathPlannerTraits traits() const noexcept override { return {}; }
  dismantle::PathResult plan(const dismantle::PathQuery&, dismantle::RunContext&) override {
    return dismantle::PathResult::failure(dismantle::Outcome::exhausted);
  }
};

}  // namespace

DISMANTLE_PLUGIN("consumer", "1.0.0", "MIT", "https://example.org") {
  r.add<dismantle::PathPlanner, Never, NeverParams>("consumer.never", "Gives up at once.", {.source = "none"});
}
