/// Refuses removals that a required check of the objective does not allow.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/path_oracle.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// A check that refused the removal of a part.
struct Refusal {
  std::string check;    ///< id
  std::string message;  ///< with the check and its reason
};

/// Lies over the oracle and its memory, because a verdict depends on the last recorded removal and an answer does not.
/// The removal that is asked about will be the operation before the last recorded one. So it is refused when it is not
/// allowed as an operation, or when the last removal is not allowed after it. Then the answer is a failure.
class RequiringOracle final : public PathOracle {
 public:
  /// `done`: what has been recorded so far. All references must outlive this.
  RequiringOracle(const Assembly& assembly, const Objective& objective, const Disassembly& done, PathOracle& oracle);
  ~RequiringOracle() override;
  /// Is there a required check?
  static bool is_needed(const Objective& objective);

  const AttemptResult& attempt(const Attempt& attempt, RunContext& context) override;
  void prefetch(std::span<const Attempt> attempts, RunContext& context) override;
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) override;
  OracleCounts counts() const override { return oracle_.counts(); }
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context) override;
  double tolerance() const override { return oracle_.tolerance(); }
  PartMemo* memo() override { return oracle_.memo(); }
  ForcingOracle* forcing() override;

  /// Id of the check that refused a removal of this part since the last recorded removal; empty: none did.
  std::string refused_by(PartId part);
  /// Says so in the reasons for parts that are left. A proof that a part cannot leave explains more.
  void explain(std::vector<Unsolved>& unsolved);

 private:
  class Forcing;

  const AttemptResult& judged(const AttemptResult& answer, const RunContext& context);
  /// The check that does not allow this removal.
  std::optional<Refusal> refusal_of(const AttemptResult& answer, const RunContext& context) const;
  void follow_steps();

  const Assembly& assembly_;
  Objective required_;  // the required checks only
  const Disassembly& done_;
  PathOracle& oracle_;
  std::unique_ptr<Forcing> forcing_;
  std::shared_ptr<const Trace> newest_;  // of the last recorded step
  std::optional<Operation> last_;
  std::map<PartId, Refusal> refusals_;
  std::deque<AttemptResult> refused_;
};

}  // namespace dismantle
