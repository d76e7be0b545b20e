/// Search for the cheapest order in which units leave a set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "dismantle/ordering/unit_set.h"

namespace dismantle::order {

/// A way in which units can leave: a motion, and how the whole lies meanwhile. Numbered from 0.
using VariantId = std::size_t;
inline constexpr VariantId kNone = std::numeric_limits<VariantId>::max();
inline constexpr double kForbidden = std::numeric_limits<double>::infinity();
inline constexpr double kSame = 1e-9;  ///< costs that differ by less are equal

/// What is to be ordered. What may leave a set may also leave each subset: units that have left block nothing.
class Problem {
 public:
  virtual ~Problem() = default;
  virtual std::size_t units() const = 0;
  /// The variants whose first unit is this one, the preferred one first.
  virtual const std::vector<VariantId>& variants_of(std::size_t unit) const = 0;
  /// False: a variant of several units holds it.
  virtual bool leaves_alone(std::size_t unit) const = 0;
  virtual const UnitSet& leaving(VariantId variant) const = 0;
  /// `present` holds the units that leave.
  virtual bool may_leave(VariantId variant, const UnitSet& present) = 0;
  /// The units of which none may be present: may_leave() without those that are known to be free, or not known.
  virtual const UnitSet& blocking(VariantId variant) = 0;
  /// Cost >= 0 of a variant that leaves `rest` behind. Steps are judged backwards, as assembly: `previous` is the
  /// variant that leaves next; kNone: none.
  virtual double cost(VariantId variant, const UnitSet& rest, VariantId previous) = 0;
  /// No cost() of the variant is lower.
  virtual double least(VariantId variant) const = 0;
  /// Bits of classes of variants. Two variants in a row without a common class cost at least `change()` more than
  /// least() of the second.
  virtual std::uint64_t classes(VariantId variant) const = 0;
  virtual double change() const = 0;
  /// Would the two probably cost little in a row? Orders the work, no more.
  virtual bool alike(VariantId a, VariantId b) const = 0;
  /// False: cost() does not depend on `previous`.
  virtual bool remembers() const { return true; }
};

/// When is it done?
enum class End {
  one_left,  ///< one unit is left, whichever
  exactly,   ///< the units of `goal` are left
  target,    ///< the unit `target` has left, alone, or is the only one that is left
};

class TargetBound;

struct Task {
  UnitSet start{};
  End end = End::one_left;
  UnitSet goal{};
  std::size_t target = 0;
  TargetBound* bound = nullptr;  ///< End::target: of the cost; must outlive this
  VariantId last = kNone;        ///< that left just before `start`; its cost counts
  VariantId next = kNone;        ///< that leaves just afterwards
};

/// A budget that is counted, not timed.
struct Effort {
  std::uint64_t left = 0;
  std::function<bool()> stop{};  ///< may be empty
  bool spend(std::uint64_t amount = 1) {
    if (left < amount) {
      left = 0;
      return false;
    }
    left -= amount;
    if ((left & 255U) == 0 && stop && stop()) left = 0;
    return true;
  }
};

struct Order {
  std::vector<VariantId> variants;
  double cost = kForbidden;  ///< kForbidden: none was found
};

/// The variants as steps of the task, one after the other: is each of them possible, and is it done in the end?
bool is_feasible(Problem& problem, const Task& task, const std::vector<VariantId>& order);
/// Cost of an order that is feasible.
double cost_of(Problem& problem, const Task& task, const std::vector<VariantId>& order);
/// A lower bound of the cost from a state on: the costs of `last` and of what has yet to leave.
double lower_bound(Problem& problem, const Task& task, const UnitSet& left, VariantId last);

struct BestFirst {
  Order best;        ///< only if it is cheaper than `known`
  double bound = 0;  ///< no order is cheaper
  bool complete = false;
};
/// A*: `complete` if the effort suffices; then `best`, or `known`, is optimal.
BestFirst best_first(Problem& problem, const Task& task, double known, Effort& effort);

/// The cheapest order to a target, for a problem of any size.
struct TargetOrder {
  Order best;        ///< only if it is cheaper than `known`
  double bound = 0;  ///< no order is cheaper
  double least = 0;  ///< the same, even if Problem::cost() is only estimated beyond Problem::least()
  double floor = 0;  ///< the same, even if may_leave() has taken what is not known for an obstacle
  bool complete = false;
};
/// First by the costs that each step has at least, with those units only that a cheap order can need; then by all
/// costs.
TargetOrder order_to(Problem& problem, const UnitSet& start, std::size_t target, double known, Effort& effort);

/// Beam search, as wide as the effort allows.
Order beam(Problem& problem, const Task& task, Effort& effort);
/// Judged steps that a beam needs to reach an order of `units` units that leave one after the other.
std::uint64_t least_effort(std::size_t units);

/// Looks for cheaper orders of some steps in a row, until none is found or the effort is spent.
void improve(Problem& problem, const Task& task, Order& order, Effort& effort);

}  // namespace dismantle::order
