/// Runs of the planner with path planners that never find anything, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "blocking/blocking.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::fake {

inline PathResult helpless(const PathQuery&, RunContext&) { return outcome(Outcome::exhausted); }

/// Fails as if it had touched all fixed parts, and as if a deeper search might succeed.
inline PathResult shallow(const PathQuery& query, RunContext&) {
  PathResult r = outcome(query.budget.max_depth == 0 ? Outcome::exhausted : Outcome::depth_limit);
  for (const PlacedPart& p : query.scene.fixed) r.blocked_by.push_back(p.part);
  return r;
}

/// Runs the planner, and expects that the plan is valid.
inline RunResult take_apart(const Assembly& assembly, unsigned threads = 1, const RunOptions& options = {},
                            Script planner = &helpless, const std::vector<NamedProver>& provers = {},
                            const BlockingParameters& params = {}) {
  RunContext context;
  context.threads = threads;
  const auto prover_of = [&](const std::string& kind) -> std::shared_ptr<const ImmobilityProver> {
    for (const NamedProver& named : provers)
      if (named.id == kind) return named.prover;
    return nullptr;
  };
  PlanningSetup used = setup(std::move(planner), std::make_shared<Blocking>(params));
  used.provers = provers;
  RunResult r = run(assembly, used, options, context);
  const PlanCheck check = check_plan(r.plan, assembly, options.verify, context, prover_of);
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return r;
}

}  // namespace dismantle::fake
