/// Sequence planners: in which order do the parts come out?
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_oracle.h"

namespace dismantle {

/// One step: a group of parts leaves the group that it was in.
struct Removal {
  std::vector<PartId> parts;   ///< as Path columns
  const AttemptResult* attempt = nullptr;
};

struct Unsolved {
  PartId part = 0;
  Outcome outcome = Outcome::exhausted;
  std::vector<PartId> blocked_by;
  std::vector<Pose> best_pose;
  std::string message;
};

struct SequenceResult {
  Outcome outcome = Outcome::crashed;  ///< solved: at most one part is left
  std::vector<Removal> removals;       ///< in order
  std::vector<PartId> remaining;       ///< parts never removed (one when solved)
  std::vector<Unsolved> unsolved;      ///< why the others are still there; empty when solved
};

/// Receives finished removals at once, so that nothing is lost by an interruption.
class DISMANTLE_API SequenceObserver {
 public:
  virtual ~SequenceObserver();
  virtual void removed(const Removal& removal, std::size_t parts_left) = 0;
};

/// Sees no planner and no simulator, so that any pair composes. Same oracle and seed, same result.
class DISMANTLE_API SequencePlanner {
 public:
  virtual ~SequencePlanner();
  virtual SequenceResult plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) = 0;
};

}  // namespace dismantle
