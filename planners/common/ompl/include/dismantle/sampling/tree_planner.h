/// From a query to a path by growing trees: what the geometric planners share.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/path/motion.h"
#include "dismantle/path_planner.h"
#include "dismantle/sampling/target_tree.h"

namespace dismantle::sampling {

using path::Motion;

/// Parameters that every tree planner has; a planner's own struct derives from this one.
struct TreeParameters {
  Motion motion = Motion::automatic;
  double goal_bias = 0.05;
  double range = 1;
  double step = 0.01;
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t level_checks = 1'000;
};

/// Declares them for a struct that derives from TreeParameters. `goal_doc`: what the goal is.
template <class P>
void describe_tree(Schema<P>& s, const std::string& goal_doc) {
  const auto own = [](auto member) {
    return static_cast<std::remove_reference_t<decltype(std::declval<P>().*member)> P::*>(member);
  };
  s.template add_choice<Motion>("motion", own(&TreeParameters::motion),
                                {{"translation", Motion::translation, "R3, orientation locked"},
                                 {"rotation", Motion::rotation, "SE(3)"},
                                 {"auto", Motion::automatic, "a tree in R3 and one in SE(3), which grow in turn"}},
                                "State space of the search.");
  s.add("goal_bias", own(&TreeParameters::goal_bias), {.unit = "1", .min = 0, .max = 1, .doc = goal_doc});
  s.add("range", own(&TreeParameters::range),
        {.unit = "unit",
         .min = 0,
         .min_open = true,
         .doc = "Longest extension towards a random state, and way between nodes towards a goal."});
  s.add("step", own(&TreeParameters::step),
        {.unit = "unit",
         .min = 1e-5,
         .max = 1,
         .doc = "Extensions go on in steps of this length, each of which is checked (table 7); largest way of any "
                "point of the part."});
  s.add(
      "tolerance_share", own(&TreeParameters::tolerance_share),
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding (table "
              "7 has all of it; the rest keeps the verifier from refusing paths)."});
  s.add("simplify", own(&TreeParameters::simplify),
        {.doc = "Replace detours by straight motions where these are free."});
  s.add("level_checks", own(&TreeParameters::level_checks),
        {.unit = "1",
         .min = 1,
         .doc = "State checks for a search of depth 1 where the sequence planner limits depth; each further level "
                "doubles them."});
}

/// How a planner chooses goals: one rule per tree. `rng` is the rule's own.
using MakeRule = std::function<std::unique_ptr<TargetRule>(SamplingProblem& problem, Rng rng)>;
/// Straight lines to try before any tree, as unit directions in the world. May be empty.
using MakeLines = std::function<std::vector<Eigen::Vector3d>(const PathQuery& query)>;

/// A search that grows trees until a path is accepted or the budget is spent;
/// two trees take turns. A path is shown to the checker simplified, and as it
/// was found if that is refused. If both are refused, the edge at fault is
/// taken out of the tree with all that grew from it, and the search goes on.
///
/// Extra statistics: `iterations`, `lines` (tried). The cost is the number of
/// state checks. The rules may be called as long as the search exists.
std::unique_ptr<PathSearch> start_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                                        const MakeRule& make_rule, const MakeLines& make_lines = {});

/// Needs of planners made with start_trees.
constexpr Capabilities kTreeNeeds{.distance = true};

}  // namespace dismantle::sampling
