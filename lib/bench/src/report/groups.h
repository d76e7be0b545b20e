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

}  // namespace dismantle::bench
