/// When which immobility prover is asked. The same for every pair of sequence and path planner.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "attempt_key.h"
#include "attempt_runner.h"
#include "dismantle/computed_once.h"
#include "dismantle/engine/run.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/part_memo.h"
#include "dismantle/path_oracle.h"

namespace dismantle {

/// Asks provers and remembers what they say. An answer depends on nothing but the question, so it does not matter which
/// thread finds it, and when. Safe to use from several threads. Certificates live as long as the schedule.
///
/// A proof comes when the search that it may spare has cost about as much as it will, or has found nothing: most
/// searches find a way before.
/// - Trivial: when the schedule is made, about all pairs that overlap when assembled.
/// - Low: in attempts of some depth or without limit, about the moving against the fixed parts.
/// - Medium: in deep attempts of one part against one other. High: after them, only where no deeper attempt can follow,
///   for the reduced tolerance.
/// - All: at the end of the run, about parts that are left: each and the only one that it touched, a few together.
///
/// What is not proved with the reduced tolerance is not proved with all of it either, and takes less time.
/// With a deadline, a proof of high effort gets no more than a share of the time that is left: others wait for their
/// turn.
class ProofSchedule {
 public:
  /// References must outlive the schedule. `context` is used for the trivial proofs, on its threads.
  ProofSchedule(const Assembly& assembly, const Verifier& verifier, std::vector<NamedProver> provers,
                const ProofOptions& options, const RunContext& context);

  /// A pair of one that moves and one that is fixed, locked by their overlap; of several leaving parts, when each of
  /// them is in such a pair.
  const Certificate* locked(const Attempt& attempt) const;
  /// What is known before a search. `attempt` is canonical.
  const Certificate* before(const Attempt& attempt) const;
  /// Proofs that are tried while a search goes on, in order, each at that number of steps and state
  /// checks. Empty: none.
  std::vector<SearchPause> during(const Attempt& attempt, const RunContext& context);
  /// What is proved because a search found nothing.
  const Certificate* after(const Attempt& attempt, const PathResult& result, const RunContext& context);
  /// At the end of a run: why `part` is left, together with the others of `left`, if that can be proved.
  const Certificate* at_last(PartId part, const std::vector<PartId>& blocked_by, const std::vector<PartId>& left,
                             const RunContext& context);
  /// As PathOracle::prove.
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context);

  /// That two parts cannot be separated, by provers of low effort first, up to `most`, for all of the tolerance.
  const Certificate* prove_pair(PartId a, PartId b, ProofEffort most, const RunContext& context);

  PartMemo& memo() { return memo_; }
  /// Time that proofs took, on all threads, those computed ahead included.
  double seconds() const { return static_cast<double>(nanoseconds_.load()) * 1e-9; }

 private:
  using Answer = std::optional<Certificate>;
  struct Prover {
    NamedProver named;
    ProverTraits traits;
  };

  bool asks(const Prover& prover, ProofEffort effort, bool depends_on_poses, std::size_t parts) const;
  std::optional<Answer> ask(const SeparationQuery& query, ProofEffort effort, bool depends_on_poses,
                            const RunContext& context);
  const Certificate* prove_reduced(PartId a, PartId b, const RunContext& context);
  const Certificate* prove_placed(const Attempt& attempt, const RunContext& context);
  const Certificate* prove_low(const Attempt& attempt, const RunContext& context);
  bool is_provable(const Attempt& attempt, unsigned depth) const;

  const Assembly& assembly_;
  double tolerance_;
  const ProofOptions options_;
  std::vector<Prover> provers_;
  PartMemo memo_;
  std::mutex mutex_;  // of the maps; answers are computed without it
  std::map<SeparationQuestion, ComputedOnce<Answer>> answers_;
  std::map<SceneDigest, ComputedOnce<Answer>> placed_answers_;
  std::vector<const Certificate*> locks_;
  std::atomic<std::uint64_t> nanoseconds_{0};
};

/// Result of an attempt that a full-tolerance certificate answers, without a search.
PathResult infeasible_by(const Certificate& certificate, const Attempt& attempt);

}  // namespace dismantle
