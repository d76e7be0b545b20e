/// Contact search: answers a path query by push searches in one or both motion spaces.
#pragma once

#include <functional>
#include <memory>

#include "dismantle/path_planner.h"
#include "dismantle/push_search/tactics.h"

namespace dismantle::push {

/// Capabilities that the simulator must have.
Capabilities required();
/// True if the query's simulator has these capabilities and can move all parts of the query.
bool fits(const PathQuery& query);

/// Searches in the motion space that the tactics name. With `motion: auto`, searches by translation and by rotation: in
/// alternation until both are exhausted (alternation.h) or, under a depth limit, one after the other (phases.h).
/// Resumes from PathQuery::resume_from if that is a Reached. If the simulator lacks a required capability, returns a
/// search that has already ended with `unsupported`. All arguments outlive the search. `between`: see Limits.
std::unique_ptr<PathSearch> start(const PathQuery& query, const Tactics& tactics, RunContext& context,
                                  std::function<void()> between = {});

}  // namespace dismantle::push
