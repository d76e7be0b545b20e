/// Search for a path in the space of displacements, shared by all geometric planners.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/parameters.h"
#include "dismantle/path_planner.h"
#include "dismantle/search/motion.h"
#include "dismantle/search/shared_parameters.h"

namespace dismantle::sampling {

using path::Motion;

/// Parameters of every geometric planner; the planner's own struct derives from this one.
struct SpaceParameters {
  Motion motion = Motion::automatic;
  double range = 1;
  double step = 0.01;
  /// Share of verify.max_penetration, beyond the initial overlap, above which a state counts as colliding. Table 7 uses
  /// all of it. Smaller: the verifier refuses fewer paths.
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t level_checks = 1'000;
  /// State checks of the first turn of each space, with `motion: auto`. Each round doubles them.
  std::int64_t first_turn = 4'000;
};

/// Declares `motion` for a struct that derives from SpaceParameters.
template <class P>
void describe_motion(Schema<P>& s) {
  s.template add_choice<Motion>("motion", &SpaceParameters::motion,
                                {{"translation", Motion::translation, "R3, orientation locked"},
                                 {"rotation", Motion::rotation, "SE(3)"},
                                 {"auto", Motion::automatic, "R3 and SE(3) in turns"}},
                                "State space of the search.");
}

/// Declares all others. `range_doc`: what `range` limits.
template <class P>
void describe_space(Schema<P>& s, const std::string& range_doc) {
  s.add("range", &SpaceParameters::range, {.unit = "unit", .min = 0, .min_open = true, .doc = range_doc});
  s.add(
      "step", &SpaceParameters::step,
      {.unit = "unit",
       .min = 1e-5,
       .max = 1,
       .doc = "Distance between the state checks along a motion (table 7), as the largest displacement of any point of "
              "the part. Smaller: thinner obstacles are detected, but each motion costs more."});
  s.advanced("tolerance_share", &SpaceParameters::tolerance_share, {0, 1});
  s.add("simplify", &SpaceParameters::simplify, {.doc = "Replace detours with free straight motions."});
  s.add("level_checks", &SpaceParameters::level_checks,
        {.unit = "1",
         .min = 1,
         .doc = "Limit of state checks for depth 1 when the sequence planner limits the depth. Each further level "
                "doubles the limit."});
  s.advanced("first_turn", &SpaceParameters::first_turn, {1, 1e12});
}

/// The structure grown in one state space until it holds a path: a tree, two trees, or a roadmap.
class SpacePlanner {
 public:
  using StateType = SamplingProblem::StateType;

  virtual ~SpacePlanner() = default;
  /// Continues until there is a path or `stop` returns true. Returns the path from the start to a separated state;
  /// empty if stopped.
  virtual std::vector<StateType> solve(const ompl::base::PlannerTerminationCondition& stop) = 0;
  /// The checker refused the motion of the last path from state `edge` - 1 to `edge`. It is not used again.
  virtual void discard(std::size_t edge) = 0;
  virtual std::uint64_t nodes() const = 0;
  virtual std::uint64_t iterations() const = 0;
  /// Of the states reached from the start, the one whose centre is furthest from it. Nothing before the first solve().
  virtual std::optional<StateType> farthest() const = 0;
};

/// Called once per state space. `rng` is the planner's own.
using MakeSpacePlanner = std::function<std::unique_ptr<SpacePlanner>(SamplingProblem& problem, const Rng& rng)>;
/// Unit directions, in the world, of straight lines to try before the search. May be empty.
using MakeLines = std::function<std::vector<Eigen::Vector3d>(const PathQuery& query)>;

/// A search that continues until a path is accepted or the budget is spent. With Motion::automatic the planners of two
/// spaces take turns. The checker gets the simplified path first, and the original one if that is refused. If both are
/// refused, the edge at fault is discarded, and the search continues.
///
/// Extra statistics: `iterations`, `lines` (tried). The cost is the number of state checks. The functions must remain
/// callable while the search exists.
std::unique_ptr<PathSearch> start_search(const PathQuery& query, RunContext& context, const SpaceParameters& parameters,
                                         const MakeSpacePlanner& make_planner, const MakeLines& make_lines = {});

/// An OMPL problem from the start to `goal`, for the set-up of an OMPL planner.
ompl::base::ProblemDefinitionPtr definition_of(SamplingProblem& problem, const ompl::base::GoalPtr& goal);

/// Needs of planners made with start_search.
constexpr Capabilities kSpaceNeeds{.distance = true};

}  // namespace dismantle::sampling
