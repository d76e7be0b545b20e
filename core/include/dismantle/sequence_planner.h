/// Sequence planners: in which order do the parts come out?
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_oracle.h"

namespace dismantle {

/// One step. The goal of its attempt says what happens: the parts leave their group; or they move and stay in it
/// (Goal::placement); or one part leaves (AttemptResult::out) and the other moved parts stay (Goal::any_of).
struct Removal {
  std::vector<PartId> parts;  ///< parts that moved, ascending, as Path columns
  const AttemptResult* attempt = nullptr;
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

/// Result of a sequence planner.
struct SequenceResult {
  /// solved: every group is one part or is kept together by constraints, or the target is out.
  Outcome outcome = Outcome::crashed;
  std::vector<Removal> removals;         ///< in order
  std::vector<PartId> remaining;         ///< parts never removed (one when solved)
  std::vector<Unsolved> unsolved;        ///< why the others are still there; empty when solved
  std::map<std::string, double> counts;  ///< the planner's own counts, by documented names
};

/// Receives each removal when it is found, so that an interruption loses nothing.
class DISMANTLE_API SequenceObserver {
 public:
  virtual ~SequenceObserver();
  virtual void removed(const Removal& removal, std::size_t parts_left) = 0;
};

/// Sees no path planner and no simulator, so that it composes with any. Same oracle and seed give the same result.
class DISMANTLE_API SequencePlanner {
 public:
  virtual ~SequencePlanner();
  /// False: a run with constraints is refused.
  virtual bool keeps_constraints() const noexcept { return false; }
  virtual SequenceResult plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) = 0;
};

}  // namespace dismantle
