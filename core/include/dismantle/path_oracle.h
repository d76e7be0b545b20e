/// All that a sequence planner sees of geometry and physics.
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
  /// For attempt() and prefetch(): the search may resume the last one that was asked for with the same moving parts at
  /// the same poses, the same goal, and at least these fixed parts at these poses; and a later one may resume this.
  /// That saves time, and the answer then depends on which attempts were asked for before, in their order. False: it
  /// depends on nothing but this question.
  bool resume = false;
};

/// What the user asks of the order. Parts by id, each list sorted by nothing in particular.
struct Constraints {
  std::vector<PartId> base;                       ///< never moved, except with everything else
  std::vector<std::vector<PartId>> together;      ///< each of these moves as one and is not taken apart
  std::vector<std::pair<PartId, PartId>> before;  ///< (a, b): b leaves only after a has left
  std::optional<PartId> target;                   ///< done as soon as this part is out; with as little work as is known
  bool empty() const { return base.empty() && together.empty() && before.empty() && !target; }
};

/// An answer, with its question. `path` has passed the verifier.
struct AttemptResult {
  /// Moving and fixed parts by ascending id, and so are the columns of the path and of the best pose, however the
  /// question listed them. An answer from memory may have been found with another max_depth.
  Attempt attempt;
  PathResult result;
  double max_penetration = 0;  ///< certified upper bound over the path, above the initial overlap; assembly units
  double seconds = 0;
  std::optional<PartId> out{};  ///< success of an attempt with Goal::any_of: the one of these that is out
  /// Why nothing was found, if that is proved; with `infeasible` always. Lives as long as the oracle.
  const Certificate* certificate = nullptr;
  double proof_seconds = 0;  ///< spent on proofs; not part of `seconds`
};

/// What an oracle has done so far.
struct OracleCounts {
  std::uint64_t attempts = 0;   ///< answered by planning
  std::uint64_t memoised = 0;   ///< answered from memory
  std::uint64_t discarded = 0;  ///< computed ahead, never asked for
  std::uint64_t proposed = 0;   ///< paths that the sequence planner found itself and proposed
  std::uint64_t refused = 0;    ///< proposals that the verifier refused
};

/// Memoises, counts and verifies. May compute prefetched attempts on other threads; answers do not depend on it.
class DISMANTLE_API PathOracle {
 public:
  virtual ~PathOracle();
  /// Reference stays valid for the life of the oracle.
  /// @throws std::invalid_argument when the attempt makes no sense: no part moves, a part is unknown or listed twice,
  /// or one of the goal does not move. @throws Error when the simulator cannot prepare the parts, which is asked of it
  /// before the first search; the run ends with that error.
  virtual const AttemptResult& attempt(const Attempt& attempt, RunContext& context) = 0;
  /// Hint: these will probably be asked for, in this order. Replaces earlier hints that were not begun.
  virtual void prefetch(std::span<const Attempt> attempts, RunContext& context) = 0;
  /// Checks a path that the caller has found, in place of a search: `path` as PathResult::path, columns as
  /// attempt.moving, which is in ascending order; it begins where the attempt has the moving parts. `solved`: valid,
  /// and the goal is reached at its end; else `exhausted`, with the part that is in the way and what is wrong.
  virtual const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) = 0;
  virtual OracleCounts counts() const = 0;
  /// Can these parts, as they are assembled, be separated at all? nullptr: not proved, by the provers of that effort.
  /// Answers are remembered, live as long as the oracle, and depend on nothing but the question; may be called from
  /// several threads. What is proved of parts holds wherever they have been moved since.
  virtual const Certificate* prove(const SeparationQuestion& question, const RunContext& context);
  /// Penetration above the initial overlap of a pair that the verifier tolerates (verify.max_penetration); assembly
  /// units. 0: an oracle without geometry, for tests.
  virtual double tolerance() const { return 0; }
  /// What is derived from the parts, shared with provers; null: none is shared. "solids": std::vector<geometry::Solid>;
  /// "hull": std::vector<Eigen::Vector3d>, corners of the convex hull.
  virtual PartMemo* memo() { return nullptr; }
  /// Only planners that declare so (SequencePlanner::keeps_constraints) are run when there are any.
  virtual const Constraints& constraints() const;
};

}  // namespace dismantle
