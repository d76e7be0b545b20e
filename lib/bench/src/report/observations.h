/// Which rows are one observation: the seeds of a planner that does not use them are no repetitions.
#pragma once

#include <vector>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// Sets ReportRow::observation of all rows. Plans are read only where the columns of several rows agree.
void number_observations(std::vector<ReportRow>& rows);

}  // namespace dismantle::bench
