/// Runs of `blocking` in tests, with path planners that find nothing.
#pragma once

#include "blocking/blocking.h"
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <set>
#include "dismantle/testing/barred_shaft.h"
#include "blocking/proofs_ahead.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/oracle_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

inline PathResult helpless(const PathQuery&, RunContext&) { return fake::outcome(Outcome::exhausted); }

/// As if it touched all that is there, and might find more a little deeper.
inline PathResult shallow(const PathQuery& query, RunContext&) {
  PathResult r = fake::outcome(query.budget.max_depth == 0 ? Outcome::exhausted : Outcome::depth_limit);
  for (const PlacedPart& p : query.cast.still) r.blocked_by.push_back(p.part);
  return r;
}

template <class Planner = decltype(&helpless)>
RunResult take_apart(const Assembly& assembly, unsigned threads = 1, RunOptions options = {},
                     Planner planner = &helpless) {
  RunContext context;
  context.threads = threads;
  Ingredients ingredients = fake::ingredients(planner, std::make_shared<Blocking>(BlockingParams{}));
  ingredients.provers = fake::built_in_provers();
  RunResult r = run(assembly, ingredients, options, context);
  const PlanCheck check = check_plan(r.plan, assembly, options.verify, context, fake::prover_of_kind);
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return r;
}

}  // namespace dismantle
