/// From a query to a path in the space of displacements: what the geometric planners share, whatever they grow.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/path/motion.h"
#include "dismantle/path/shared_parameters.h"
#include "dismantle/path_planner.h"
#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::sampling {

using path::Motion;

/// Parameters that every geometric planner has; a planner's own struct derives from this one.
struct SpaceParameters {
  Motion motion = Motion::automatic;
  double range = 1;
  double step = 0.01;
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t level_checks = 1'000;
};

/// Declares `motion` for a struct that derives from SpaceParameters.
template <class P>
void describe_motion(Schema<P>& s) {
  s.template add_choice<Motion>("motion", path::inherited<P>(&SpaceParameters::motion),
                                {{"translation", Motion::translation, "R3, orientation locked"},
                                 {"rotation", Motion::rotation, "SE(3)"},
                                 {"auto", Motion::automatic, "R3 and SE(3) in turn"}},
                                "State space of the search.");
}

/// Declares all others. `range_doc`: what `range` limits.
template <class P>
void describe_space(Schema<P>& s, const std::string& range_doc) {
  using path::inherited;
  s.add("range", inherited<P>(&SpaceParameters::range), {.unit = "unit", .min = 0, .min_open = true, .doc = range_doc});
  s.add("step", inherited<P>(&SpaceParameters::step),
        {.unit = "unit",
         .min = 1e-5,
         .max = 1,
         .doc = "Extensions go on in steps of this length, each of which is checked (table 7); largest way of any "
                "point of the part."});
  s.add(
      "tolerance_share", inherited<P>(&SpaceParameters::tolerance_share),
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding (table "
              "7 has all of it; the rest keeps the verifier from refusing paths)."});
  s.add("simplify", inherited<P>(&SpaceParameters::simplify),
        {.doc = "Replace detours by straight motions where these are free."});
  s.add("level_checks", inherited<P>(&SpaceParameters::level_checks),
        {.unit = "1",
         .min = 1,
         .doc = "State checks for a search of depth 1 where the sequence planner limits depth; each further level "
                "doubles them."});
}

/// What is grown in one state space until it holds a path: a tree, two trees, a roadmap.
class SpacePlanner {
 public:
  using StateType = SamplingProblem::StateType;

  virtual ~SpacePlanner() = default;
  /// Goes on until there is a path or `stop` says so. From the start to a state that is out; empty: stopped.
  virtual std::vector<StateType> solve(const ompl::base::PlannerTerminationCondition& stop) = 0;
  /// The checker refused the last path for its motion from state `edge` - 1 to `edge`: it is not used again.
  virtual void discard(std::size_t edge) = 0;
  virtual std::uint64_t nodes() const = 0;
  virtual std::uint64_t iterations() const = 0;
  /// Of the states reached from the start, the one whose centre went furthest. Nothing: not begun.
  virtual std::optional<StateType> farthest() const = 0;
};

/// One per state space. `rng` is its own.
using MakeSpacePlanner = std::function<std::unique_ptr<SpacePlanner>(SamplingProblem& problem, const Rng& rng)>;
/// Straight lines to try before anything is grown, as unit directions in the world. May be empty.
using MakeLines = std::function<std::vector<Eigen::Vector3d>(const PathQuery& query)>;

/// A search that goes on until a path is accepted or the budget is spent; with Motion::automatic the planners of two
/// spaces take turns. A path is shown to the checker simplified, and as it was found if that is refused. If both are
/// refused, the edge at fault is discarded, and the search goes on.
///
/// Extra statistics: `iterations`, `lines` (tried). The cost is the number of state checks. The functions may be called
/// as long as the search exists.
std::unique_ptr<PathSearch> start_search(const PathQuery& query, RunContext& context, const SpaceParameters& parameters,
                                         const MakeSpacePlanner& make_planner, const MakeLines& make_lines = {});

/// An OMPL problem from the start to `goal`; what SpacePlanner classes set up their OMPL planner with.
ompl::base::ProblemDefinitionPtr definition_of(SamplingProblem& problem, const ompl::base::GoalPtr& goal);

/// Needs of planners made with start_search.
constexpr Capabilities kSpaceNeeds{.distance = true};

}  // namespace dismantle::sampling
