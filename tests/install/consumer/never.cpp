/// A path planner that gives up at once: the smallest plugin there can be.
#include <dismantle/plugin.h>

namespace {

struct NeverParameters {
  double patience = 1;
  static void describe(dismantle::Schema<NeverParameters>& s) {
    s.add("patience", &NeverParameters::patience, {.unit = "s", .min = 0, .doc = "Not used up."});
  }
};

class Never : public dismantle::FunctionPathPlanner {
 public:
  explicit Never(const NeverParameters&) {}
  dismantle::PathPlannerTraits traits() const noexcept override { return {}; }
  dismantle::PathResult plan(const dismantle::PathQuery&, dismantle::RunContext&) override {
    return dismantle::PathResult::failure(dismantle::Outcome::exhausted);
  }
};

}  // namespace

DISMANTLE_PLUGIN("consumer", "1.0.0", "MIT", "https://example.org") {
  r.add<dismantle::PathPlanner, Never, NeverParameters>("consumer.never", "Gives up at once.", {.source = "none"});
}
