/// The only access of a sequence planner to geometry and physics.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/path_planner.h"

namespace dismantle {

/// "Can these parts leave while those are where they are, with this effort?" All other parts are gone.
struct Attempt {
  std::vector<PlacedPart> moving;
  std::vector<PlacedPart> fixed;
  unsigned max_depth = 0;  ///< 0 = no limit
  Goal goal{};
  /// For attempt() and prefetch(). True: the search may resume the latest one with the same moving parts at the same
  /// poses, the same goal, and at least these fixed parts at these poses; a later search may resume this one. This
  /// saves time, but the answer depends on earlier attempts and their order. False: it depends on this question only.
  bool resume = false;
  /// For attempt() and prefetch(): another answer to the same question. Searches that use random numbers draw others;
  /// 0: the usual ones.
  std::uint64_t seed = 0;
  /// The shortest path of so many searches, with the seeds `seed`, `seed` + 1, ...; >= 1. Length: of the way of the
  /// point that travels furthest.
  unsigned best_of = 1;
  /// Steps and state checks that a search may spend on a better path once it has one, if it says that it may improve.
  std::uint64_t improve_steps = 0;
};

/// A removal that was forced: the path, and what is known about it.
struct ForcedRemoval {
  Path path;  ///< columns in the order of the moving parts; as it is written to the plan
  ForcedCut cut;
};

/// A part that is left, and why.
struct Unsolved {
  PartId part = 0;
  Outcome outcome = Outcome::exhausted;
  std::vector<PartId> blocked_by;
  std::vector<Pose> best_pose;
  std::string message;
  const Certificate* certificate = nullptr;  ///< of the oracle: proof that it cannot leave
};

/// An answer, with its question. `path` has passed the verifier.
struct AttemptResult {
  /// Moving and fixed parts by ascending id, in whatever order the question listed them; the columns of the path and of
  /// the best pose use the same order. A remembered answer may have been found with another max_depth.
  Attempt attempt;
  PathResult result;
  double max_penetration = 0;  ///< certified upper bound over the path, above the initial overlap; assembly units
  double seconds = 0;
  std::optional<PartId> out{};  ///< success with Goal::any_of: the part of that list that is separated
  /// Proof that explains why no path was found, if any; always set for `infeasible`. Lives as long as the oracle.
  const Certificate* certificate = nullptr;
  double proof_seconds = 0;  ///< spent on proofs; not part of `seconds`
  bool proposed = false;     ///< the caller found the path: an answer of propose()
  /// Set by ForcingOracle::propose_forced only; `result` then is no success and has no path.
  std::shared_ptr<const ForcedRemoval> forced{};

  /// Can the answer be recorded as a removal: is it a success, or forced?
  bool removes() const { return forced || is_success(result.outcome()); }
  /// The motion of a removal. @throws std::logic_error when there is none.
  const Path& path() const {
    if (forced) return forced->path;
    if (!result.path()) throw std::logic_error("an answer without a path");
    return result.path()->poses();
  }
};

/// What an oracle has done so far.
struct OracleCounts {
  std::uint64_t attempts = 0;   ///< answered by planning
  std::uint64_t memoised = 0;   ///< answered from memory
  std::uint64_t discarded = 0;  ///< computed speculatively, never asked for
  std::uint64_t proposed = 0;   ///< paths that the sequence planner found itself and proposed
  std::uint64_t refused = 0;    ///< proposals that the verifier refused
};

/// Access for planners that remove parts by force, where no verified path is known. Not thread-safe.
class DISMANTLE_API ForcingOracle {
 public:
  virtual ~ForcingOracle();
  /// How deep the parts cut in along the path (columns as `moving`), measured on the original triangles. Nothing: no
  /// pair comes near each other. When `context` asks to stop: the deepest so far, not `proved`.
  virtual std::optional<MotionDepth> depth(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                           const Path& path, const MotionDepthOptions& options,
                                           const RunContext& context) = 0;
  /// Tries proofs about parts that are left without one; they explain more than the messages of searches do. `groups`:
  /// the groups that are left.
  virtual void prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                          const RunContext& context) = 0;
  /// Answers with a removal along this path, whatever it cuts into, and states depth and reason. `known`: what is known
  /// of the depth; stated, as a lower bound, if time runs out. The answer may be recorded like a success.
  virtual const AttemptResult& propose_forced(const Attempt& attempt, const Path& path,
                                              const std::optional<MotionDepth>& known, std::span<const Unsolved> said,
                                              RunContext& context) = 0;
};

/// Memoises, counts and verifies. May compute prefetched attempts on other threads; answers do not depend on it.
class DISMANTLE_API PathOracle {
 public:
  virtual ~PathOracle();
  /// Reference stays valid for the life of the oracle.
  /// @throws std::invalid_argument for an ill-formed attempt: no part moves, a part is unknown or listed twice, or a
  /// part of the goal does not move. @throws Error when the simulator cannot prepare the parts before the first search;
  /// the run ends with that error.
  virtual const AttemptResult& attempt(const Attempt& attempt, RunContext& context) = 0;
  /// Hint: these will probably be asked for, in this order. Replaces earlier hints whose computation has not begun.
  virtual void prefetch(std::span<const Attempt> attempts, RunContext& context) = 0;
  /// Checks a path that the caller has found, instead of searching. `path` begins at the poses of attempt.moving; its
  /// columns are in the same, ascending order. Returns `solved` if the path is valid and ends at the goal, otherwise
  /// `exhausted` with the blocking part and the reason.
  virtual const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) = 0;
  /// Which of `attempt.fixed` have to be gone for this path to be valid and to end at the goal? Ascending; empty: it is
  /// valid as it is. None: no set of them helps, or `context` wants to stop. As propose(), which this calls until it
  /// accepts: a part that is named was in the way when the parts named before it were gone.
  virtual std::optional<std::vector<PartId>> obstacles(const Attempt& attempt, const Path& path, RunContext& context);
  virtual OracleCounts counts() const = 0;
  /// Proof that these parts, as assembled, cannot be separated; nullptr if the provers of that effort find none.
  /// Answers are remembered, live as long as the oracle, and depend only on the question. May be called from several
  /// threads. A proof still holds after valid motions.
  virtual const Certificate* prove(const SeparationQuestion& question, const RunContext& context);
  /// Penetration above the initial overlap of a pair that the verifier tolerates (verify.max_penetration); assembly
  /// units. 0: an oracle without geometry, for tests.
  virtual double tolerance() const { return 0; }
  /// Data derived from the parts, shared with provers; null: none is shared. "solids": std::vector<geometry::Solid>;
  /// "hull": std::vector<Eigen::Vector3d>, corners of the convex hull.
  virtual PartMemo* memo() { return nullptr; }
  /// Null: the run allows no forced steps (`run.force: off`).
  virtual ForcingOracle* forcing() { return nullptr; }
};

}  // namespace dismantle
