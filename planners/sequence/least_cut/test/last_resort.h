/// Test helper: a sequence planner followed by `least_cut`.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "chain/chain.h"
#include "dismantle/testing/run_rig.h"
#include "least_cut/least_cut.h"

namespace dismantle::fake {

/// A reference to this planner, as the host would bind it.
inline PluginRef<SequencePlanner> ref_to(std::string type, std::shared_ptr<SequencePlanner> planner) {
  return {PluginChoice{std::move(type), {}, {}},
          [planner](PluginKind, const PluginChoice&) -> std::shared_ptr<void> { return planner; }};
}

/// The planner, then forced steps.
inline std::shared_ptr<SequencePlanner> last_resort_after(std::shared_ptr<SequencePlanner> first,
                                                          const LeastCutParameters& forced = {}) {
  ChainParameters params;
  params.of = {ref_to("first", std::move(first)), ref_to("least_cut", std::make_shared<LeastCut>(forced))};
  return std::make_shared<Chain>(params);
}

/// A run that may force steps after `first`.
inline RunResult forced_run(const Assembly& assembly, std::shared_ptr<SequencePlanner> first, RunContext context = {},
                            RunOptions options = {}, const LeastCutParameters& forced = {}) {
  options.force = ForceWhen::last_resort;
  return run(assembly, setup(push, last_resort_after(std::move(first), forced)), options, context);
}

}  // namespace dismantle::fake
