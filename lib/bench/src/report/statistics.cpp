#include <algorithm>
#include <cmath>

#include "dismantle/bench/statistics.h"

namespace dismantle::bench {

Proportion wilson(double hits, double n) {
  const double z = 1.959963984540054;  // 97.5 % quantile of the normal distribution
  const double p = hits / n;
  const double scale = 1 / (1 + z * z / n);
  const double middle = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  // For 0 hits the lower bound is 0, and for n hits the upper bound is 1, up to rounding: state them exactly.
  return {p, hits == 0 ? 0 : std::max(0.0, middle - half), hits == n ? 1 : std::min(1.0, middle + half)};
}

double sign_test(std::size_t wins, std::size_t losses) {
  const double n = double(wins + losses);
  double tail = 0;
  for (std::size_t i = 0; i <= std::min(wins, losses); ++i) {
    const double k = double(i);
    tail += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) - n * std::log(2));
  }
  return std::min(1.0, 2 * tail);
}

namespace {

/// Twice the ranks of the sorted values, so that the mean rank of equal values is whole.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& sorted) {
  std::vector<std::size_t> out(sorted.size());
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i;
    while (end < sorted.size() && sorted[end] == sorted[i]) ++end;
    std::fill(out.begin() + std::ptrdiff_t(i), out.begin() + std::ptrdiff_t(end), i + 1 + end);
    i = end;
  }
  return out;
}

/// Probability that the sum of the ranks with a random sign is as far from its mean as `sum` is, or farther.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t total, std::size_t sum) {
  std::vector<double> probability(total + 1, 0.0);
  probability[0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t s = total + 1; s-- > 0;)
      probability[s] = (probability[s] + (s >= rank ? probability[s - rank] : 0)) / 2;
  const auto distance = [total](std::size_t s) { return std::max(2 * s, total) - std::min(2 * s, total); };
  double p = 0;
  for (std::size_t s = 0; s <= total; ++s)
    if (distance(s) >= distance(sum)) p += probability[s];
  return std::min(1.0, p);
}

double approximate_p(const std::vector<std::size_t>& ranks, double plus) {
  double mean = 0, variance = 0;
  for (const std::size_t doubled : ranks) {  // the sum of the squares has the correction for ties in it
    const double rank = double(doubled) / 2;
    mean += rank / 2;
    variance += rank * rank / 4;
  }
  const double z = std::max(0.0, std::abs(plus - mean) - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.0));
}

}  // namespace

SignedRanks wilcoxon(std::vector<double> differences) {
  std::erase(differences, 0.0);
  std::sort(differences.begin(), differences.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes;
  for (const double d : differences) sizes.push_back(std::abs(d));
  const std::vector<std::size_t> ranks = doubled_ranks(sizes);
  std::size_t plus = 0, total = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    total += ranks[i];
    plus += differences[i] > 0 ? ranks[i] : 0;
  }
  SignedRanks out;
  out.n = ranks.size();
  if (out.n == 0) return out;
  out.plus = double(plus) / 2;
  out.minus = double(total - plus) / 2;
  out.effect = (out.plus - out.minus) / (out.plus + out.minus);
  out.p = out.n <= 50 ? exact_p(ranks, total, plus) : approximate_p(ranks, out.plus);
  return out;
}

SuccessSteps success_over_time(std::vector<std::pair<double, bool>> events, std::size_t never) {
  // At equal times, solved trials precede censored ones, since the censored ones were still running at that time.
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second && !b.second;
  });
  SuccessSteps steps;
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

std::optional<double> time_to(const SuccessSteps& steps, double share) {
  for (const auto& [seconds, reached] : steps)
    if (reached >= share - 1e-12) return seconds;  // 1 minus a product is rounded
  return std::nullopt;
}

double restricted_mean(const SuccessSteps& steps, double end) {
  double area = 0, last = 0, left = 1;
  for (const auto& [seconds, share] : steps) {
    if (seconds >= end) break;
    area += left * (seconds - last);
    last = seconds;
    left = 1 - share;
  }
  return area + left * (end - last);
}

}  // namespace dismantle::bench
