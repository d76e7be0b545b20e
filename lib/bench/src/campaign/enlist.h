/// Lists the trials of a suite, each of which becomes a row.
#pragma once

#include <vector>

#include "dismantle/bench/campaign.h"
#include "dismantle/bench/trial.h"
#include "store/results.h"

namespace dismantle::bench {

/// A trial of this process's shard.
struct Enlisted {
  TrialPlan plan;
  TrialRequest request;
};

struct Enlistment {
  std::vector<Enlisted> trials;
  Wanted wanted;  ///< its `trials` are empty
};

/// True when `only` is empty or names `planner`.
bool is_wanted(const std::string& planner, const std::vector<std::string>& only);
/// @throws Error when `only` names a planner that the suite lacks.
void check_planners(const Suite& suite, const std::vector<std::string>& only);

/// Writes each configuration to `folder`/configs, where the trials read it.
Enlistment enlist(const Suite& suite, const CampaignOptions& options);

}  // namespace dismantle::bench
