// acme.from_above: a step check. Parts should be put in from above: a step costs as much as its direction differs from
// straight down. From the side or from below, somebody has to hold the part; the plan says so in a note.
#include <algorithm>
#include <cmath>
#include <string>

#include "dismantle/plugin.h"

namespace {

struct AcmeFromAboveParameters {
  double angle = 1.0;

  static void describe(dismantle::Schema<AcmeFromAboveParameters>& s) {
    s.add("angle", &AcmeFromAboveParameters::angle,
          {.unit = "rad",
           .min = 0,
           .max = 3.2,
           .doc = "A part that is put in farther from straight down has to be held."});
  }
};

class AcmeFromAbove final : public dismantle::StepCheck {
 public:
  explicit AcmeFromAbove(const AcmeFromAboveParameters& params) : params_(params) {}

  /// It reads nothing of the step before.
  dismantle::StepCheckTraits traits() const noexcept override { return {}; }

  dismantle::StepVerdict judge(const dismantle::StepQuestion& question,
                               const dismantle::RunContext& /*context*/) const override {
    dismantle::StepVerdict verdict;
    if (question.direction.isZero()) return verdict;  // a rotation in place
    const double cosine = std::clamp(-question.direction.dot(question.up), -1.0, 1.0);
    verdict.cost = (1 - cosine) / 2;  // 0 from above, 1 from below
    if (std::acos(cosine) <= params_.angle) {
      if (verdict.cost > 0) verdict.reason = "not straight from above";
      return verdict;
    }
    const std::string name = question.assembly.parts[question.moving.front().part].name;
    verdict.allowed = false;
    verdict.reason = "'" + name + "' is put in from the side or from below";
    verdict.notes.push_back({"acme.from_above.hold", "Hold '" + name + "' until it is fastened.",
                             "{\"angle\": " + std::to_string(std::acos(cosine)) + "}"});
    return verdict;
  }

 private:
  AcmeFromAboveParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.from_above", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::StepCheck, AcmeFromAbove, AcmeFromAboveParameters>("acme.from_above", "Parts are put in from above.",
                                                                      {.source = "own"});
}
