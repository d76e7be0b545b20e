/// Two trees that grow towards each other, in a separate library: most transfers need no trees, and loading OMPL takes
/// longer than all transfers of a small assembly.
#pragma once

#include "dismantle/transfer_planner.h"
#include "parameters.h"

/// The function that the library exports. `goal`: the displacement to find a path for; the simulator has distance
/// queries for the moving parts.
extern "C" __attribute__((visibility("default"))) void dismantle_connect_by_trees(
    const dismantle::rrt_connect::Parameters& parameters, const dismantle::TransferQuery& query,
    const dismantle::Pose& goal, dismantle::RunContext& context, dismantle::PathResult& result);
