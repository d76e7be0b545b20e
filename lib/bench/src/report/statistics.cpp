#include <algorithm>
#include <cmath>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

Proportion wilson(std::size_t hits, std::size_t n) {
  const double z = 1.959963984540054;  // 97.5 % quantile of the normal distribution
  const double count = double(n), p = double(hits) / count;
  const double scale = 1 / (1 + z * z / count);
  const double middle = scale * (p + z * z / (2 * count));
  const double half = scale * z * std::sqrt(p * (1 - p) / count + z * z / (4 * count * count));
  // For 0 hits the lower bound is 0, and for n hits the upper bound is 1, up to rounding: state them exactly.
  return {p, hits == 0 ? 0 : std::max(0.0, middle - half), hits == n ? 1 : std::min(1.0, middle + half)};
}

std::vector<std::pair<double, double>> success_over_time(std::vector<std::pair<double, bool>> events,
                                                         std::size_t never) {
  // At equal times, solved trials precede censored ones, since the censored ones were still running at that time.
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second && !b.second;
  });
  std::vector<std::pair<double, double>> steps;
  double left = 1;
  for (std::size_t i = 0; i < events.size();) {
    std::size_t solved = 0, same = i;
    for (; same < events.size() && events[same].first == events[i].first; ++same) solved += events[same].second ? 1 : 0;
    if (solved > 0) {
      left *= 1 - double(solved) / double(events.size() - i + never);
      steps.emplace_back(events[i].first, 1 - left);
    }
    i = same;
  }
  return steps;
}

}  // namespace dismantle::bench
