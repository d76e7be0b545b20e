/// The actions of each stage.
#pragma once

#include <vector>

#include "dismantle/geometry/twist.h"
#include "dismantle/push_search/problem.h"
#include "dismantle/push_search/work.h"

namespace dismantle::push {

/// The actions of a stage in this state. Not for Stage::twists, which follows proposed_screws().
std::vector<Action> actions_at(Problem& problem, Work& work, const State& state, Stage stage);

/// Slippable motions along the contacts, in both directions, the shortest way out first.
std::vector<geometry::Twist> proposed_screws(Problem& problem, Work& work, const State& state);

/// Wrenches that drive the bodies from `state` along a screw, with an additional velocity `lean`. They rotate with the
/// bodies.
Action along(const Problem& problem, const geometry::Twist& screw, const State& state,
             const Eigen::Vector3d& lean = Eigen::Vector3d::Zero());

/// At the start of the query, every motion that the contacts guide has a rotation, and one of them separates the part:
/// then translations are useless. False without further tests for parts that touch nothing or can translate. Cheap.
bool screw_leads_out(const Problem& problem);

}  // namespace dismantle::push
