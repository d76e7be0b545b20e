/// Decides when each immobility prover is asked, independent of the sequence and path planners.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt_key.h"
#include "attempt_runner.h"
#include "dismantle/computed_once.h"
#include "dismantle/engine/run.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/part_memo.h"
#include "dismantle/path_oracle.h"

namespace dismantle {

/// Asks provers and remembers their answers. An answer depends only on the question, so it does not matter which thread
/// finds it or when. Safe to use from several threads. Certificates live as long as the schedule.
///
/// A proof is tried once the search that it may save has cost about as much as the proof will, or has found no path;
/// most searches find a path before.
/// - Trivial: on construction, about all pairs that overlap when assembled.
/// - Low: in attempts of some depth or without limit, about the moving against the fixed parts; sooner about one part
///   and those that it touched most.
/// - Medium: in deep attempts of one part against one other. High: after these, with the reduced tolerance, only if no
///   deeper attempt can follow.
/// - All: at the end of the run, about each remaining part and the only part that it touched, or about a few together;
///   and about the pair that a forced step cuts through deepest.
///
/// Proofs of high effort try multiples of the tolerance where what holds a pair is far deeper, else the reduced
/// tolerance: it takes less time than the full one, and what is not proved with it is not proved with the full
/// tolerance either. Pairs that snap are not asked about. With a deadline, each gets only a share of the remaining
/// time, because others wait for their turn.
class ProofSchedule {
 public:
  /// References must outlive the schedule. `context` is used for the trivial proofs, on its threads.
  ProofSchedule(const Assembly& assembly, const Verifier& verifier, std::vector<NamedProver> provers,
                const ProofOptions& options, const RunContext& context);

  /// Proof that the overlap of a moving and a fixed part locks them, or null. With Goal::any_of: only if each listed
  /// part is locked to another part.
  const Certificate* locked(const Attempt& attempt) const;
  /// A proof that is known before a search, or null. `attempt` is canonical.
  const Certificate* before(const Attempt& attempt) const;
  /// Proofs to try during a search, in order, each at its number of steps and state checks.
  std::vector<SearchPause> during(const Attempt& attempt, const RunContext& context);
  /// Tries proofs after a search that found no path.
  const Certificate* after(const Attempt& attempt, const PathResult& result, const RunContext& context);
  /// At the end of a run: a proof about `part` and others of `group`, the parts that it is not separated from (`part`
  /// included), or null.
  const Certificate* at_last(PartId part, const std::vector<PartId>& blocked_by, const std::vector<PartId>& group,
                             const RunContext& context);
  /// As PathOracle::prove.
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context);

  /// Proof that two parts cannot be separated, for the full tolerance; by provers of low effort first, up to `most`.
  const Certificate* prove_pair(PartId a, PartId b, ProofEffort most, const RunContext& context);
  /// With high effort: for the full tolerance if that can be proved, else for the reduced one.
  const Certificate* prove_high(PartId a, PartId b, const RunContext& context);

  PartMemo& memo() { return memo_; }
  /// Time of all proofs, summed over threads, speculative ones included.
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
  const Certificate* answer_to(const SeparationQuestion& key, const RunContext& context);
  double cut_of(PartId a, PartId b, const RunContext& context);
  const Certificate* prove_reduced(PartId a, PartId b, const RunContext& context);
  const Certificate* prove_placed(const Attempt& attempt, const RunContext& context);
  const Certificate* prove_low(const Attempt& attempt, const RunContext& context);
  bool is_holdable(const Attempt& attempt) const;
  const Certificate* prove_held(const Attempt& attempt, const std::vector<PartId>& touched, const RunContext& context);
  bool is_provable(const Attempt& attempt, unsigned depth) const;

  const Assembly& assembly_;
  const Verifier& verifier_;
  double tolerance_;
  const ProofOptions options_;
  std::vector<Prover> provers_;
  PartMemo memo_;
  std::mutex mutex_;  // guards the maps; answers are computed without it
  std::map<SeparationQuestion, ComputedOnce<Answer>> answers_;
  std::map<SceneDigest, ComputedOnce<Answer>> placed_answers_;
  std::map<std::pair<PartId, PartId>, ComputedOnce<double>> cuts_;  // as straight_cut()
  std::vector<const Certificate*> locks_;
  std::atomic<std::uint64_t> nanoseconds_{0};
};

/// Result of an attempt that a full-tolerance certificate answers, without a search.
PathResult infeasible_by(const Certificate& certificate, const Attempt& attempt);

}  // namespace dismantle
