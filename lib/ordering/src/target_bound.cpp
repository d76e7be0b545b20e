#include "dismantle/ordering/target_bound.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace dismantle::order {

TargetBound::TargetBound(Problem& problem, const UnitSet& start, std::size_t target, double known, bool target_may_stay)
    : problem_(problem),
      target_(target),
      target_may_stay_(target_may_stay),
      variants_(problem.units()),
      cheapest_(problem.units(), kForbidden),
      options_(problem.units()),
      useful_(problem.units()),
      nothing_(problem.units()),
      everything_(problem.units(), true),
      necessary_(problem.units(), nothing_) {
  for (std::size_t u = 0; u < problem.units(); ++u)
    for (const VariantId v : problem.variants_of(u))
      problem.leaving(v).each([&](std::size_t own) {
        variants_[own].push_back(v);
        cheapest_[own] = std::min(cheapest_[own], problem.least(v));
      });
  find_useful(start, known);
}

/// Ways that another one of the unit is not worse than are left out.
void TargetBound::add_options(std::size_t unit) {
  std::vector<Option>& options = options_[unit];
  for (const VariantId v : variants_[unit]) {
    if (problem_.leaving(v).contains(target_) && problem_.leaving(v).size() > 1) continue;
    Option option{problem_.leaving(v), problem_.blocking(v), problem_.least(v), v};
    const auto is_better = [](const Option& a, const Option& b) {
      return a.leaving == b.leaving && b.blocking.includes(a.blocking) && a.least <= b.least;
    };
    if (std::any_of(options.begin(), options.end(), [&](const Option& other) { return is_better(other, option); }))
      continue;
    std::erase_if(options, [&](const Option& other) { return is_better(option, other); });
    options.push_back(std::move(option));
  }
}

/// A unit that is removed for the sake of the target is the first of a row of units, each of them in the way of the
/// next, which all leave, one after the other, and the target last.
void TargetBound::find_useful(const UnitSet& start, double known) {
  using Entry = std::pair<double, std::size_t>;  // least cost of such a row, unit
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<double> best(problem_.units(), kForbidden);
  const auto reach = [&](std::size_t unit, double cost) {
    if (!(cost < known - kSame) || !(cost < best[unit] - kSame)) return;
    best[unit] = cost;
    open.emplace(cost, unit);
  };
  reach(target_, cheapest_[target_]);
  if (target_may_stay_)
    start.each([&](std::size_t u) {
      if (u != target_) reach(u, cheapest_[u]);
    });
  while (!open.empty()) {
    const auto [cost, unit] = open.top();
    open.pop();
    if (useful_.contains(unit)) continue;
    useful_.insert(unit);
    add_options(unit);
    for (const Option& option : options_[unit]) {
      option.leaving.each([&, with = cost](std::size_t u) { reach(u, with); });
      UnitSet obstacles = option.blocking;
      obstacles &= start;
      obstacles.each([&, before = cost](std::size_t u) { reach(u, before + cheapest_[u]); });
    }
  }
  if (target_may_stay_) useful_.insert(target_);
}

/// For each unit the way that costs least with all that has to leave before, each of these counted by itself, as far as
/// it does not leave in any case; in the order in which they can leave. The last one is the target's, or there is none.
std::vector<const TargetBound::Option*> TargetBound::supported(const UnitSet& left, const UnitSet& in_any_case) const {
  constexpr double kShare = 1e-3;  // of the cost of what leaves in any case
  struct Open {
    const Option* option;
    std::size_t waits = 0;  // for so many units
    double before = 0;
  };
  std::vector<Open> options;
  std::vector<std::vector<std::size_t>> waiting(problem_.units());
  using Entry = std::pair<double, std::size_t>;  // cost with all before, way
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> ready;
  (left - (left - useful_)).each([&](std::size_t u) {
    for (const Option& option : options_[u]) {
      std::size_t first = 0;
      while (!option.leaving.contains(first)) ++first;
      if (first != u || !left.includes(option.leaving)) continue;  // once for all units that leave
      UnitSet obstacles = option.blocking;
      obstacles &= left;
      options.push_back({&option, obstacles.size(), 0});
      obstacles.each([&](std::size_t b) { waiting[b].push_back(options.size() - 1); });
      if (options.back().waits == 0) ready.emplace(option.least, options.size() - 1);
    }
  });
  std::vector<const Option*> order;
  UnitSet gone = nothing_;
  while (!ready.empty()) {
    const auto [cost, at] = ready.top();
    ready.pop();
    const Option& option = *options[at].option;
    if (gone.intersects(option.leaving)) continue;
    order.push_back(&option);
    if (option.leaving.contains(target_)) return order;
    const double counted = in_any_case.includes(option.leaving) ? kShare * cost : cost;
    option.leaving.each([&](std::size_t u) {
      gone.insert(u);
      for (const std::size_t other : waiting[u]) {
        Open& open = options[other];
        open.before += counted;
        if (--open.waits == 0) ready.emplace(open.option->least + open.before, other);
      }
    });
  }
  return {};
}

std::vector<VariantId> TargetBound::some_order(const UnitSet& left) const {
  std::vector<VariantId> best;
  double least = kForbidden;
  UnitSet in_any_case = nothing_;
  constexpr int kRounds = 6;  // what one round removes costs little in the next one
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<const Option*> order = supported(left, in_any_case);
    if (order.empty()) break;
    UnitSet needed = nothing_;
    needed.insert(target_);
    std::vector<VariantId> variants;
    double cost = 0;
    for (auto option = order.rbegin(); option != order.rend(); ++option) {
      if (!needed.intersects((*option)->leaving)) continue;
      UnitSet before = (*option)->blocking;
      before &= left;
      needed |= before;
      variants.push_back((*option)->variant);
      cost += (*option)->least;
    }
    if (!(cost < least - kSame)) break;
    least = cost;
    best.assign(variants.rbegin(), variants.rend());
    in_any_case = needed;
  }
  return best;
}

/// One step may remove all units that do not leave alone.
double TargetBound::least_of(const UnitSet& units) const {
  double sum = 0, together = 0;
  units.each([&](std::size_t u) {
    if (problem_.leaves_alone(u))
      sum += cheapest_[u];
    else
      together = std::max(together, cheapest_[u]);
  });
  return sum + together;
}

double TargetBound::least_if_it_stays(const UnitSet& left) const {
  UnitSet others = left;
  others.erase(target_);
  return least_of(others);
}

/// What must have left before the way is free, as far as is known; false: it never gets free.
bool TargetBound::needs(const Option& option, const UnitSet& left, UnitSet& units) const {
  units = nothing_;
  if (!left.includes(option.leaving)) return false;
  UnitSet obstacles = option.blocking;
  obstacles &= left;
  obstacles.each([&](std::size_t u) { units |= necessary_[u]; });
  return !units.intersects(option.leaving);
}

/// From below: what is known after each round is necessary.
void TargetBound::find_necessary(const UnitSet& left) {
  left.each([&](std::size_t u) {
    necessary_[u] = useful_.contains(u) && !options_[u].empty() ? nothing_ : everything_;
    necessary_[u].insert(u);
  });
  UnitSet active = left, of_option;
  active &= useful_;
  constexpr int kRounds = 8;
  bool changed = true;
  for (int round = 0; changed && round < kRounds; ++round) {
    changed = false;
    active.each([&](std::size_t u) {
      UnitSet common = everything_;
      for (const Option& option : options_[u])
        if (needs(option, left, of_option)) common &= of_option;
      common.insert(u);
      if (common == necessary_[u]) return;
      necessary_[u] = std::move(common);
      changed = true;
    });
  }
}

double TargetBound::of(const UnitSet& left) {
  if (const auto known = known_.find(left); known != known_.end()) return known->second;
  find_necessary(left);
  double best = target_may_stay_ ? least_if_it_stays(left) : kForbidden;
  UnitSet before;
  for (const Option& option : options_[target_])
    if (needs(option, left, before)) best = std::min(best, option.least + least_of(before));
  known_.emplace(left, best);
  return best;
}

}  // namespace dismantle::order
