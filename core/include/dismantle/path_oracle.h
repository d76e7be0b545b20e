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

class PairChecker;
struct AttemptResult;

/// "Can these parts leave together while those stay, with this effort?" All other parts are out.
struct Attempt {
  std::vector<PlacedPart> moving;
  std::vector<PlacedPart> still;
  unsigned max_depth = 0;  ///< 0 = no limit
  /// For propose() only: the parts are shifted and stay in their group. The way has to be valid, not to lead out.
  bool part_way = false;
  /// Not empty: the moving parts move at once, each in its own way, until one of these (they are among `moving`) is
  /// out: apart from all others, moving and still. The others that moved stay in their group, where the way ends.
  std::vector<PartId> leaving{};
  /// A later attempt may go on from this one: where it is in vain, what it has reached is kept in memory.
  bool keep_reached = false;
  /// For attempt() and prefetch(): null, or an answer of the same oracle to an attempt in vain of the same parts from
  /// the same places, in which these parts stood still where they are now, and perhaps others that are out by now. The
  /// search goes on from the states that were reached then, if they were kept and the path planner can. Part of the
  /// question: the same attempt after another one, or after none, is another question.
  const AttemptResult* after = nullptr;
};

/// What the user asks of the order. Parts by id, each list sorted by nothing in particular.
struct Constraints {
  std::vector<PartId> base;                       ///< never moved, except with everything else
  std::vector<std::vector<PartId>> together;      ///< each of these moves as one and is not taken apart
  std::vector<std::pair<PartId, PartId>> before;  ///< (a, b): b leaves only after a has left
  std::optional<PartId> target;                   ///< done as soon as this part is out; with as little work as is known
  bool empty() const { return base.empty() && together.empty() && before.empty() && !target; }
};

/// An answer. `path` has passed the verifier.
struct AttemptResult {
  PathResult result;
  double max_penetration = 0;  ///< certified upper bound over the path, above the initial overlap; assembly units
  double seconds = 0;
  std::optional<PartId> out{};  ///< success of an attempt with Attempt::leaving: who of these is out
  /// Why nothing was found, if that is proved; with `infeasible` always. Lives as long as the oracle.
  const Certificate* certificate = nullptr;
  double proof_seconds = 0;  ///< spent on proofs; not part of `seconds`
};

struct OracleCounts {
  std::uint64_t attempts = 0;   ///< answered by planning
  std::uint64_t memoised = 0;   ///< answered from memory
  std::uint64_t discarded = 0;  ///< computed ahead, never asked for
  std::uint64_t proposed = 0;   ///< ways that the sequence planner found itself, put to the judge
  std::uint64_t refused = 0;    ///< ... of which the judge refused so many
};

/// Memoises, counts and verifies. May compute prefetched attempts on other threads; answers do not depend on it.
class DISMANTLE_API PathOracle {
 public:
  virtual ~PathOracle();
  /// Reference stays valid for the life of the oracle.
  /// @throws std::invalid_argument when the attempt makes no sense: nobody moves, a part is unknown or listed twice,
  /// someone leaves who does not move, or Attempt::after is not what it has to be.
  virtual const AttemptResult& attempt(const Attempt& attempt, RunContext& context) = 0;
  /// Hint: these will probably be asked for, in this order. Replaces earlier hints that were not begun.
  virtual void prefetch(std::span<const Attempt> attempts, RunContext& context) = 0;
  /// Judges a way that the asker has found itself, in place of a search: `way` as PathResult::path, its first instant
  /// where the attempt has the moving parts. `solved`: valid, and (unless part_way) it ends apart from what stays,
  /// with `leaving` one of these;
  /// else `exhausted`, with the part that is in the way and what is wrong.
  virtual const AttemptResult& propose(const Attempt& attempt, const Path& way, RunContext& context) = 0;
  virtual OracleCounts counts() const = 0;
  /// Can these parts, as they are assembled, be separated at all? nullptr: not proved, by the provers of that effort.
  /// Answers are remembered, live as long as the oracle, and depend on nothing but the question; may be called from
  /// several threads. What is proved of parts holds wherever they have been moved since.
  virtual const Certificate* prove(const SeparationQuestion& question, const RunContext& context);
  /// Facts about pairs of parts. nullptr: an oracle without geometry.
  virtual const PairChecker* pair_checker() const { return nullptr; }
  /// Only planners that declare so (SequencePlanner::keeps_constraints) are run when there are any.
  virtual const Constraints& constraints() const;
};

}  // namespace dismantle
