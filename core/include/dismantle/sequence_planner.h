/// Sequence planners: in which order do the parts come out?
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_oracle.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// One step. The goal of its attempt says what happens: the parts leave their group; or they move and stay in it
/// (Goal::placement); or one part leaves (AttemptResult::out) and the other moved parts stay (Goal::any_of).
struct Removal {
  std::vector<PartId> parts;  ///< parts that moved, ascending, as Path columns
  const AttemptResult* attempt = nullptr;
  std::string planner{};  ///< id of the sequence planner that proposed the path; empty: the one of the run
  std::optional<Eigen::Vector3d> up{};  ///< unit; how the assembly lies during the step; none: as Objective::up
};

/// The removal as a step of a disassembly: which parts move along which path, and which of them leave. What its search
/// has found out is added by the engine. @throws std::logic_error when the answer is no removal.
DISMANTLE_API DisassemblyStep step_of(const Removal& removal);

/// Result of a sequence planner.
struct SequenceResult {
  /// solved: every group is one part or is kept together by constraints, or the target is out.
  Outcome outcome = Outcome::crashed;
  std::vector<Removal> removals;         ///< in order
  std::vector<PartId> remaining;         ///< parts never removed (one when solved)
  std::vector<Unsolved> unsolved;        ///< why the others are still there; empty when solved
  std::map<std::string, double> counts;  ///< the planner's own counts, by documented names
  /// No order of what was asked for has a lower cost by the objective: a proved bound. None: not known.
  std::optional<double> least_cost{};
  std::vector<const Certificate*> proofs{};  ///< of the oracle: about parts that have left since, for the plan to state
};

/// Receives each removal when it is found, so that an interruption loses nothing.
class DISMANTLE_API SequenceObserver {
 public:
  virtual ~SequenceObserver();
  virtual void removed(const Removal& removal, std::size_t parts_left) = 0;
  /// Takes the last `count` removals back, so that others can be announced in their place. False: this observer keeps
  /// what it was given, and nothing has changed.
  virtual bool taken_back(std::size_t count);
};

/// What a sequence planner can do; constant for an object.
struct SequencePlannerTraits {
  bool keeps_constraints = false;  ///< false: a run with constraints is refused
  /// True: starts from any SequenceQuery::start. False: only from one group of all parts as assembled; other runs are
  /// refused.
  bool any_start = false;
  bool follows_objective = false;  ///< prefers removals that SequenceQuery::objective likes
  bool forces = false;             ///< works only with PathOracle::forcing(); does nothing where there is none
};

/// What is to be taken apart. References outlive the call.
struct SequenceQuery {
  const Assembly& assembly;
  /// Groups to take apart, each in ascending order of parts. A whole assembly is one group; a half-finished plan may
  /// have several. Parts in none of them are absent.
  std::vector<std::vector<PlacedPart>> start;
  const Constraints& constraints;
  const Objective& objective;
  /// What earlier planners of this run said about parts that are still left.
  std::span<const Unsolved> said{};
};

/// One group of all parts as assembled.
DISMANTLE_API std::vector<std::vector<PlacedPart>> whole_assembly(const Assembly& assembly);

/// Sees no path planner and no simulator, so that it composes with any. Same oracle and seed give the same result.
class DISMANTLE_API SequencePlanner {
 public:
  virtual ~SequencePlanner();
  virtual SequencePlannerTraits traits() const noexcept { return {}; }
  virtual SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) = 0;
};

}  // namespace dismantle
