/// Tables that have no counterpart in the paper.
#pragma once

#include "report/groups.h"

namespace dismantle::bench {

/// Pairs of planners in one variant, compared on the trials that both solved.
Table pairs_table(const std::vector<Contender>& contenders);
/// Penetration depths along the plans.
Table precision_table(const std::vector<Contender>& contenders);
/// How trials ended.
Table outcomes_table(const std::vector<Contender>& contenders);
/// The curves at a few times.
Table curves_table(const ReportData& data);
/// Every row. `plans`: folder with the plans, relative to the page.
Table trials_table(const ReportData& data, const std::string& plans);

}  // namespace dismantle::bench
