#include "requiring_oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/engine/judgement.h"

namespace dismantle {

/// Forced removals have to be allowed, too.
class RequiringOracle::Forcing final : public ForcingOracle {
 public:
  Forcing(RequiringOracle& owner, ForcingOracle& inner) : owner_(owner), inner_(inner) {}
  std::optional<MotionDepth> depth(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                   const Path& path, const MotionDepthOptions& options,
                                   const RunContext& context) override {
    return inner_.depth(moving, fixed, path, options, context);
  }
  void prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                  const RunContext& context) override {
    inner_.prove_left(unsolved, groups, context);
  }
  const AttemptResult& propose_forced(const Attempt& attempt, const Path& path, const std::optional<MotionDepth>& known,
                                      std::span<const Unsolved> said, RunContext& context) override {
    return owner_.judged(inner_.propose_forced(attempt, path, known, said, context), context);
  }

 private:
  RequiringOracle& owner_;
  ForcingOracle& inner_;
};

RequiringOracle::RequiringOracle(const Assembly& assembly, const Objective& objective, const Disassembly& done,
                                 PathOracle& oracle)
    : assembly_(assembly), done_(done), oracle_(oracle) {
  required_.up = objective.up;
  for (const ObjectiveItem& item : objective.items)
    if (item.require) required_.items.push_back(item);
  if (ForcingOracle* inner = oracle.forcing()) forcing_ = std::make_unique<Forcing>(*this, *inner);
}

RequiringOracle::~RequiringOracle() = default;

bool RequiringOracle::is_needed(const Objective& objective) {
  return std::any_of(objective.items.begin(), objective.items.end(),
                     [](const ObjectiveItem& item) { return item.require; });
}

const AttemptResult& RequiringOracle::attempt(const Attempt& attempt, RunContext& context) {
  return judged(oracle_.attempt(attempt, context), context);
}

void RequiringOracle::prefetch(std::span<const Attempt> attempts, RunContext& context) {
  oracle_.prefetch(attempts, context);
}

const AttemptResult& RequiringOracle::propose(const Attempt& attempt, const Path& path, RunContext& context) {
  return judged(oracle_.propose(attempt, path, context), context);
}

const Certificate* RequiringOracle::prove(const SeparationQuestion& question, const RunContext& context) {
  return oracle_.prove(question, context);
}

ForcingOracle* RequiringOracle::forcing() { return forcing_.get(); }

std::string RequiringOracle::refused_by(PartId part) {
  follow_steps();
  const auto refusal = refusals_.find(part);
  return refusal == refusals_.end() ? "" : refusal->second.check;
}

void RequiringOracle::explain(std::vector<Unsolved>& unsolved) {
  follow_steps();
  for (Unsolved& u : unsolved)
    if (const auto refusal = refusals_.find(u.part); refusal != refusals_.end() && u.certificate == nullptr)
      u.message = refusal->second.message;
}

void RequiringOracle::follow_steps() {
  const auto& steps = done_.steps();
  const std::shared_ptr<const Trace> newest = steps.empty() ? nullptr : steps.back().path;
  if (newest == newest_) return;
  newest_ = newest;
  refusals_.clear();
  last_.reset();
  if (newest) last_.emplace(operation_of(done_, steps.size() - 1, assembly_, required_.up));
}

std::optional<Refusal> RequiringOracle::refusal_of(const AttemptResult& answer, const RunContext& context) const {
  const auto refusal = [&](const StepQuestion& question) -> std::optional<Refusal> {
    const ObjectiveVerdict verdict = required_.judge(question, context);
    if (!verdict.refused) return std::nullopt;
    const std::string& id = required_.items[*verdict.refused].id;
    const std::string& reason = verdict.verdicts[*verdict.refused].reason;
    return Refusal{id, fmt::format("the step check '{}', which is required, does not allow it{}", id,
                                   reason.empty() ? "" : ": " + reason)};
  };
  const Attempt& asked = answer.attempt;
  const Operation operation(assembly_, asked.moving, asked.fixed, answer.path(), required_.up);
  const StepQuestion question = operation.question();
  if (auto refused = refusal(question)) return refused;
  return last_ ? refusal(last_->question(&question)) : std::nullopt;
}

const AttemptResult& RequiringOracle::judged(const AttemptResult& answer, const RunContext& context) {
  if (!answer.removes() || answer.attempt.goal.placement || answer.path().size() < 2) return answer;
  follow_steps();
  std::optional<Refusal> refusal = refusal_of(answer, context);
  if (!refusal) return answer;
  for (const PlacedPart& p : answer.attempt.moving) refusals_[p.part] = *refusal;
  AttemptResult& failure = refused_.emplace_back();
  failure.attempt = answer.attempt;
  failure.seconds = answer.seconds;
  failure.result.fail(Outcome::exhausted, refusal->message);
  return failure;
}

}  // namespace dismantle
