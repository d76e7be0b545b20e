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
  std::vector<ConfigRecord> configs;
};

/// Writes each configuration to `folder`/configs, where the trials read it.
Enlistment enlist(const Suite& suite, const CampaignOptions& options);

}  // namespace dismantle::bench
