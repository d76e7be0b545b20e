/// The tables that the paper does not have.
#pragma once

#include "report/groups.h"

namespace dismantle::bench {

/// Two planners of one variant on what both solved.
Table pairs_table(const std::vector<Contender>& contenders);
/// How deep parts cut into each other along the plans.
Table precision_table(const std::vector<Contender>& contenders);
/// How trials ended.
Table outcomes_table(const std::vector<Contender>& contenders);
/// The curves at a few times.
Table curves_table(const ReportData& data);
/// Every row. `plans`: where its plan lies, seen from the page.
Table trials_table(const ReportData& data, const std::string& plans);

}  // namespace dismantle::bench
