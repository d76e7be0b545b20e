/// Groups of rows for the tables.
#pragma once

#include <functional>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// A planner in a variant; most tables have one row for each.
struct Contender {
  std::string planner, variant, label;
  std::vector<const ReportRow*> rows;
};
/// In the order of the suite; those without rows are left out.
std::vector<Contender> contenders_of(const ReportData& data);

/// The time of a trial that reports use: planning time, or, if the trial was killed, the time until then.
double time_of(const ReportRow& row);

/// time_of(), but not more than what stops a trial: planners stop slightly after it.
double observed_time(const ReportRow& row);

/// True if a limit of the trial stopped it, so that it might have been solved later. A trial whose attempts all ended
/// before that limit (also by limits.path_timeout) would not have continued.
bool out_of_time(const ReportRow& row);

}  // namespace dismantle::bench
