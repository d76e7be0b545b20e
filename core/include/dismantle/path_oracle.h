/// The only access of a sequence planner to geometry and physics.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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
};

/// The user's constraints on the sequence. Parts by id; the lists are in no particular order.
struct Constraints {
  std::vector<PartId> base;                       ///< never moved, except with everything else
  std::vector<std::vector<PartId>> together;      ///< each of these moves as one and is not taken apart
  std::vector<std::pair<PartId, PartId>> before;  ///< (a, b): b leaves only after a has left
  std::optional<PartId> target;                   ///< done as soon as this part is out; with as little work as is known
  bool empty() const { return base.empty() && together.empty() && before.empty() && !target; }
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
};

/// What an oracle has done so far.
struct OracleCounts {
  std::uint64_t attempts = 0;   ///< answered by planning
  std::uint64_t memoised = 0;   ///< answered from memory
  std::uint64_t discarded = 0;  ///< computed speculatively, never asked for
  std::uint64_t proposed = 0;   ///< paths that the sequence planner found itself and proposed
  std::uint64_t refused = 0;    ///< proposals that the verifier refused
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
  /// If there are any, only planners that declare SequencePlanner::keeps_constraints are run.
  virtual const Constraints& constraints() const;
};

}  // namespace dismantle
