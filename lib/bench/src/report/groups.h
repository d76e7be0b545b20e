/// Rows grouped as the tables need them.
#pragma once

#include <functional>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// A planner in a variant: a row of most tables.
struct Contender {
  std::string planner, variant, label;
  std::vector<const ReportRow*> rows;
};
/// In the order of the suite; those without rows are left out.
std::vector<Contender> contenders_of(const ReportData& data);

/// Time that counts for a trial: what it took to plan, or, when it did not end by itself, until it was killed.
double time_of(const ReportRow& row);

}  // namespace dismantle::bench
