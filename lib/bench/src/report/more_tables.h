/// Tables that have no counterpart in the paper.
#pragma once

#include "report/groups.h"

namespace dismantle::bench {

/// Machine, versions, limits and date.
Table setup_table(const ReportData& data);
/// The plugins of each planner.
Table planners_table(const ReportData& data);
/// Pairs of planners in one variant, compared on their common trials.
Table pairs_table(const std::vector<Contender>& contenders);
/// Penetration depths along the plans.
Table precision_table(const std::vector<Contender>& contenders);
/// Steps, directions and lengths of the plans, costs by step checks.
Table plans_table(const std::vector<Contender>& contenders);
/// The planners' own counts.
Table counts_table(const std::vector<Contender>& contenders);
/// A table of a suite: means of figures that it names.
Table suite_table(const SuiteTable& wanted, const std::vector<Contender>& contenders);
/// Parts that are out after a time.
Table progress_table(const ReportData& data);
/// Ways of the best states of searches after some effort.
Table searches_table(const ReportData& data);
/// How trials ended.
Table outcomes_table(const std::vector<Contender>& contenders);
/// The curves at a few times.
Table curves_table(const ReportData& data);
/// Quantiles and restricted means of the curves.
Table solution_table(const ReportData& data);
/// Every row. `links`: see tables_of().
Table trials_table(const ReportData& data, const std::vector<std::string>& links);

}  // namespace dismantle::bench
