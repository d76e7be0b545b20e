/// From a query to a path by growing trees: what the geometric planners share.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dismantle/sampling/space_search.h"
#include "dismantle/sampling/target_tree.h"

namespace dismantle::sampling {

/// Parameters that every tree planner has; a planner's own struct derives from this one.
struct TreeParameters : SpaceParameters {
  double goal_bias = 0.05;
};

/// Declares them for a struct that derives from TreeParameters. `goal_doc`: what the goal is.
template <class P>
void describe_tree(Schema<P>& s, const std::string& goal_doc) {
  describe_motion(s);
  s.add("goal_bias", path::inherited<P>(&TreeParameters::goal_bias),
        {.unit = "1", .min = 0, .max = 1, .doc = goal_doc});
  describe_space(s, "Longest extension towards a random state, and way between nodes towards a goal.");
}

/// How a planner chooses goals: one rule per tree. `rng` is the rule's own.
using MakeRule = std::function<std::unique_ptr<TargetRule>(SamplingProblem& problem, Rng rng)>;

/// start_search with one tree in each space. Of a path that was refused, all that grew from the edge at fault goes,
/// too.
std::unique_ptr<PathSearch> start_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                                        const MakeRule& make_rule, const MakeLines& make_lines = {});

/// Needs of planners made with start_trees.
constexpr Capabilities kTreeNeeds = kSpaceNeeds;

}  // namespace dismantle::sampling
