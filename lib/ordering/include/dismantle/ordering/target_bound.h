/// What has to leave before one unit can: a lower bound of the cost until it is out.
#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "dismantle/ordering/order_search.h"

namespace dismantle::order {

/// Each unit has units that leave before it in every order: those that are necessary for all its blockers along each of
/// its ways. Together they cost at least the sum of their cheapest variants.
class TargetBound {
 public:
  /// Only orders that cost less than `known` count; what no such order removes is not useful().
  /// `target_may_stay`: orders count, too, in which everything else leaves and the target stays.
  TargetBound(Problem& problem, const UnitSet& start, std::size_t target, double known, bool target_may_stay);

  /// Units that may be worth removing, with the target.
  const UnitSet& useful() const { return useful_; }
  /// No order from here on that costs less than `known` in all costs less than this; kForbidden: there is none.
  double of(const UnitSet& left);
  /// Some order of useful units, most likely a cheap one; empty: none was found. What is not known to be in the way is
  /// taken to be free.
  std::vector<VariantId> some_order(const UnitSet& left) const;
  /// No order costs less in which the target stays and everything else leaves.
  double least_if_it_stays(const UnitSet& left) const;

 private:
  /// Units that leave in one motion, and what must have left before. Of several variants the cheapest.
  struct Option {
    UnitSet leaving, blocking;
    double least = 0;
    VariantId variant = kNone;
  };
  void add_options(std::size_t unit);
  void find_useful(const UnitSet& start, double known);
  double least_of(const UnitSet& units) const;
  std::vector<const Option*> supported(const UnitSet& left, const UnitSet& in_any_case) const;
  void find_necessary(const UnitSet& left);
  bool needs(const Option& option, const UnitSet& left, UnitSet& units) const;

  Problem& problem_;
  std::size_t target_;
  bool target_may_stay_;
  std::vector<std::vector<VariantId>> variants_;  // by unit that leaves, whether first or not
  std::vector<double> cheapest_;                  // by unit, of the variants that hold it
  std::vector<std::vector<Option>> options_;      // by unit; empty until it is known to be useful
  UnitSet useful_, nothing_, everything_;
  std::vector<UnitSet> necessary_;  // by unit, with the unit itself; everything: it cannot leave
  std::unordered_map<UnitSet, double, UnitSetHash> known_;
};

}  // namespace dismantle::order
