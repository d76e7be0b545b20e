/// Search for a path by growing trees, shared by the tree planners.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dismantle/ompl/space_search.h"
#include "dismantle/ompl/target_tree.h"

namespace dismantle::sampling {

/// Parameters of every tree planner; the planner's own struct derives from this one.
struct TreeParameters : SpaceParameters {
  double goal_bias = 0.05;
};

/// Declares the parameters of a struct that derives from TreeParameters. `goal_doc`: doc of `goal_bias`.
template <class P>
void describe_tree(Schema<P>& s, const std::string& goal_doc) {
  describe_motion(s);
  s.add("goal_bias", &TreeParameters::goal_bias, {.unit = "1", .min = 0, .max = 1, .doc = goal_doc});
  describe_space(
      s, "Longest extension towards a random state, and distance of the nodes towards a goal. Larger: fewer nodes.");
}

/// Makes the rule by which a tree chooses its goals. `rng` is the rule's own.
using MakeRule = std::function<std::unique_ptr<TargetRule>(SamplingProblem& problem, Rng rng)>;

/// start_search with one tree in each space. When a path is refused, the subtree behind the edge at fault is discarded.
std::unique_ptr<PathSearch> start_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                                        const MakeRule& make_rule, const MakeLines& make_lines = {});

/// Needs of planners made with start_trees.
constexpr Capabilities kTreeNeeds = kSpaceNeeds;

}  // namespace dismantle::sampling
