/// One attempt, from question to verified answer. The only place where a path planner is called.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "attempt_key.h"
#include "deferred_simulator.h"
#include "dismantle/engine/run.h"
#include "dismantle/path_oracle.h"
#include "path_normalizer.h"

namespace dismantle {

/// A proof to try once a search has spent this number of steps and state checks. Null: the search continues. It is told
/// the parts that the search has touched so far, those that it touched most first.
struct SearchPause {
  std::uint64_t steps = 0;  ///< > 0, more than at the previous pause
  std::function<const Certificate*(const std::vector<PartId>& touched)> proof;
};

struct ComputedAttempt {
  AttemptResult answer;
  bool interrupted = false;  ///< ended by cancellation or the run's deadline: says nothing about the question
};

/// Immutable after construction; run() may be called from several threads, with one planner each.
class AttemptRunner {
 public:
  /// All references must outlive the runner. `deferred` (may be null) prepares the parts before the first search. `rng`
  /// is the run's generator.
  AttemptRunner(const Assembly& assembly, const PreparedAssembly& prepared, const PlanningSetup& setup,
                const DeferredSimulator* deferred, const RunOptions& options, const Verifier& verifier, const Rng& rng);

  /// `attempt` is canonical and `key` belongs to it. The deadline of `context` is that of the run; the time limit of
  /// the attempt is added here. `resumed`: null, or the answer of the search that this one resumes. A proof found in
  /// `pauses` ends the search and is part of the answer; its time is not counted as search time. Does not throw:
  /// exceptions of plugins become Outcome::crashed.
  ComputedAttempt run(PathPlanner& planner, const Attempt& attempt, const AttemptKey& key, const AttemptResult* resumed,
                      const std::vector<SearchPause>& pauses, const RunContext& context) const;

  /// Verifies a given path instead of searching. The columns of `path` are in the order of `attempt.moving`.
  ComputedAttempt check_proposal(const Attempt& attempt, const Path& path, const RunContext& context) const;

  /// Upper bound of the way of any point on the path of `answer`, a success; assembly units.
  double length(const AttemptResult& answer) const { return normalizer_.length(answer.path(), answer.attempt.moving); }
  const std::string& planner_id() const { return planner_id_; }

 private:
  class Checker;
  PathResult plan(PathPlanner& planner, const Attempt& attempt, const AttemptResult* resumed, RunContext& context,
                  const Checker& checker, const std::vector<SearchPause>& pauses, AttemptResult& answer) const;
  std::optional<PartId> first_out(const Attempt& attempt, const std::vector<PlacedPart>& group) const;
  void explain(const MotionCheck& motion, const NormalizedPath& written, PathCheck& answer) const;
  bool is_prepared(const RunContext& context, PathResult& result) const;
  std::string lacking(const Capabilities& needs, std::size_t moving) const;

  const Assembly& assembly_;
  const PreparedAssembly& prepared_;
  const DeferredSimulator* deferred_;
  const Simulator& simulator_;
  const Verifier& verifier_;
  std::string planner_id_;
  double path_timeout_;
  std::uint64_t path_steps_;
  Rng rng_;
  PathNormalizer normalizer_;
};

}  // namespace dismantle
