/// `tables:` of a suite.
#pragma once

#include <array>
#include <vector>

#include "dismantle/bench/suite.h"

namespace dismantle::bench {

/// The tables that reports always have.
inline constexpr std::array kOwnTables{"setup",    "planners", "success",   "sizes",  "time",
                                       "solution", "plans",    "precision", "pairs",  "outcomes",
                                       "counts",   "progress", "searches",  "curves", "trials"};

/// Reads the list; problems are added to `problems`.
std::vector<SuiteTable> read_tables(const ConfigNode& list, std::vector<Diagnostic>& problems);

}  // namespace dismantle::bench
