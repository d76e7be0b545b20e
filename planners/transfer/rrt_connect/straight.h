/// Ways that one sees at once: lift, turn, carry over, put down.
#pragma once

#include <vector>

#include "dismantle/transfer_planner.h"

namespace dismantle::rrt_connect {

/// Candidates, the likeliest first: over everything on the side `up`, below everything, straight from place to place,
/// around on the other four sides. The group turns about its middle where all else is at least `clearance` (assembly
/// units) away.
std::vector<Path> straight_ways(const TransferQuery& query, double clearance);

/// The displacement that takes the group from start to goal. False: the goal is not the group moved as a rigid body.
bool displacement_to_goal(const TransferQuery& query, Pose& displacement);

}  // namespace dismantle::rrt_connect
