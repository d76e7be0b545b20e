#include "dismantle/orders/agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace dismantle {
namespace {

using Ranks = std::map<std::string, std::vector<double>>;

/// The ranks of the parts of each class, ascending.
Ranks ranks_of(const Order& order, const PartClasses& classes) {
  Ranks ranks;
  for (std::size_t k = 0; k < order.size(); ++k)
    for (const std::string& part : order[k].parts) {
      const auto known = classes.find(part);
      ranks[known == classes.end() ? part : known->second].push_back(static_cast<double>(k));
    }
  return ranks;
}

}  // namespace

std::optional<double> kendall_tau_b(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw std::invalid_argument("two rankings of different items");
  std::int64_t balance = 0, in_a = 0, in_b = 0;  // pairs: concordant less discordant; not tied in a; not tied in b
  const auto sign = [](double x) { return (x > 0) - (x < 0); };
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const int s = sign(a[i] - a[k]), t = sign(b[i] - b[k]);
      balance += s * t;
      in_a += s != 0;
      in_b += t != 0;
    }
  if (in_a == 0 || in_b == 0) return std::nullopt;
  return static_cast<double>(balance) / std::sqrt(static_cast<double>(in_a) * static_cast<double>(in_b));
}

Agreement agreement_of(const Order& a, const Order& b, const PartClasses& classes) {
  const Ranks of_a = ranks_of(a, classes), of_b = ranks_of(b, classes);
  std::vector<double> x, y;
  for (const auto& [name, ranks] : of_a) {
    const auto there = of_b.find(name);
    if (there == of_b.end()) continue;
    const std::size_t common = std::min(ranks.size(), there->second.size());
    x.insert(x.end(), ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(common));
    y.insert(y.end(), there->second.begin(), there->second.begin() + static_cast<std::ptrdiff_t>(common));
  }
  return {kendall_tau_b(x, y), x.size()};
}

}  // namespace dismantle
