/// Statistics of comparisons: intervals of shares, paired tests, times to solution with censoring.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/export.h"

namespace dismantle::bench {

/// Success rate `hits` / `n` with its 95 % Wilson interval; n > 0. `hits` need not be whole: a share of observations.
struct Proportion {
  double share = 0, low = 0, high = 0;
};
DISMANTLE_API Proportion wilson(double hits, double n);

/// Two-sided p-value of the exact sign test (for pairs of yes and no: of the exact McNemar test); ties are left out.
DISMANTLE_API double sign_test(std::size_t wins, std::size_t losses);

/// Wilcoxon's signed-rank test. Exact, also with ties, up to 50 differences; above, the normal approximation with the
/// corrections for ties and for continuity.
struct SignedRanks {
  std::size_t n = 0;            ///< differences that are not 0
  double plus = 0, minus = 0;   ///< sums of ranks
  double p = 1;                 ///< two-sided
  double effect = 0;            ///< matched-pairs rank-biserial correlation: 1 when all differences are positive
};
DISMANTLE_API SignedRanks wilcoxon(std::vector<double> differences);

/// Share of trials solved within a time, 1 - Kaplan-Meier: a step (seconds, share) at each time of a solution. Events:
/// seconds, and true for solved or false for censored. `never`: number of other trials.
using SuccessSteps = std::vector<std::pair<double, double>>;
DISMANTLE_API SuccessSteps success_over_time(std::vector<std::pair<double, bool>> events, std::size_t never);

/// The time within which `share` of the trials are solved; none if fewer are.
DISMANTLE_API std::optional<double> time_to(const SuccessSteps& steps, double share);

/// Mean time to solution, where a trial that is not solved until `end` counts with `end` (restricted mean).
DISMANTLE_API double restricted_mean(const SuccessSteps& steps, double end);

}  // namespace dismantle::bench
