/// From a suite to the rows that it asks for.
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

/// Writes each configuration to `folder`/configs, where trials find it.
Enlistment enlist(const Suite& suite, const CampaignOptions& options);

}  // namespace dismantle::bench
