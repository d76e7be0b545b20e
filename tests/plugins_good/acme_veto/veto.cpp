// acme.veto: a sequence planner that holds another one, and shows it an oracle around the oracle: removals that end
// below where they began are not possible, whatever the simulator and the verifier say.
#include <deque>

#include "dismantle/plugin.h"

namespace {

struct VetoParameters {
  dismantle::PluginRef<dismantle::SequencePlanner> planner{"progressive"};
  double drop = 0;

  static void describe(dismantle::Schema<VetoParameters>& s) {
    s.add("planner", &VetoParameters::planner, {.doc = "The planner that looks for the sequence."});
    s.add("drop", &VetoParameters::drop,
          {.unit = "assembly units", .min = 0, .doc = "A part may end this far below where it began."});
  }
};

/// Passes every question on, and turns the answers that break the rule into failures. Answers have to live as long as
/// the oracle, so it keeps its own.
class VetoOracle final : public dismantle::PathOracle {
 public:
  VetoOracle(dismantle::PathOracle& inner, const Eigen::Vector3d& up, double drop)
      : inner_(inner), up_(up), drop_(drop) {}

  const dismantle::AttemptResult& attempt(const dismantle::Attempt& attempt, dismantle::RunContext& context) override {
    return judged(inner_.attempt(attempt, context));
  }
  const dismantle::AttemptResult& propose(const dismantle::Attempt& attempt, const dismantle::Path& path,
                                          dismantle::RunContext& context) override {
    return judged(inner_.propose(attempt, path, context));
  }
  void prefetch(std::span<const dismantle::Attempt> attempts, dismantle::RunContext& context) override {
    inner_.prefetch(attempts, context);
  }
  dismantle::OracleCounts counts() const override { return inner_.counts(); }
  const dismantle::Certificate* prove(const dismantle::SeparationQuestion& question,
                                      const dismantle::RunContext& context) override {
    return inner_.prove(question, context);
  }
  double tolerance() const override { return inner_.tolerance(); }
  dismantle::PartMemo* memo() override { return inner_.memo(); }

  std::size_t vetoes() const { return refused_.size(); }

 private:
  const dismantle::AttemptResult& judged(const dismantle::AttemptResult& answer) {
    if (!answer.removes() || answer.path().empty()) return answer;
    const dismantle::Path& path = answer.path();
    double lowest = 0;
    for (std::size_t i = 0; i < path.front().size(); ++i)
      lowest = std::min(lowest, up_.dot(path.back()[i].t - path.front()[i].t));
    if (lowest >= -drop_) return answer;
    dismantle::AttemptResult& failure = refused_.emplace_back();
    failure.attempt = answer.attempt;
    failure.seconds = answer.seconds;
    failure.result.fail(dismantle::Outcome::exhausted, "the part would be taken out downwards (acme.veto)");
    return failure;
  }

  dismantle::PathOracle& inner_;
  const Eigen::Vector3d up_;
  const double drop_;
  std::deque<dismantle::AttemptResult> refused_;
};

class Veto final : public dismantle::SequencePlanner {
 public:
  explicit Veto(const VetoParameters& params) : planner_(params.planner.create()), drop_(params.drop) {}

  dismantle::SequencePlannerTraits traits() const noexcept override { return planner_->traits(); }

  dismantle::SequenceResult plan(const dismantle::SequenceQuery& query, dismantle::PathOracle& oracle,
                                 dismantle::SequenceObserver& observer, dismantle::RunContext& context) override {
    VetoOracle veto(oracle, query.objective.up, drop_);
    dismantle::SequenceResult result = planner_->plan(query, veto, observer, context);
    result.counts["vetoes"] = static_cast<double>(veto.vetoes());
    return result;
  }

 private:
  std::shared_ptr<dismantle::SequencePlanner> planner_;
  double drop_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.veto", "1.0.0", "MIT", "https://example.org/veto") {
  r.add<dismantle::SequencePlanner, Veto, VetoParameters>("acme.veto", "A sequence without removals downwards.",
                                                          {.source = "own"});
}
