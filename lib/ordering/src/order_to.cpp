#include <algorithm>

#include "dismantle/ordering/order_search.h"
#include "dismantle/ordering/target_bound.h"

namespace dismantle::order {

namespace {

/// Each step costs what it costs at least, whatever is left and whatever was before.
class Alone final : public Problem {
 public:
  explicit Alone(Problem& of) : of_(of) {}
  std::size_t units() const override { return of_.units(); }
  const std::vector<VariantId>& variants_of(std::size_t unit) const override { return of_.variants_of(unit); }
  bool leaves_alone(std::size_t unit) const override { return of_.leaves_alone(unit); }
  const UnitSet& leaving(VariantId v) const override { return of_.leaving(v); }
  bool may_leave(VariantId v, const UnitSet& present) override { return of_.may_leave(v, present); }
  const UnitSet& blocking(VariantId v) override { return of_.blocking(v); }
  double cost(VariantId v, const UnitSet& /*rest*/, VariantId /*previous*/) override { return of_.least(v); }
  double least(VariantId v) const override { return of_.least(v); }
  std::uint64_t classes(VariantId /*v*/) const override { return 0; }
  double change() const override { return 0; }
  bool alike(VariantId a, VariantId b) const override { return of_.alike(a, b); }
  bool remembers() const override { return false; }

 private:
  Problem& of_;
};

class Search {
 public:
  Search(Problem& problem, const UnitSet& start, std::size_t target, double known, Effort& effort)
      : problem_(problem), alone_(problem), effort_(effort) {
    task_.start = start;
    task_.end = End::target;
    task_.target = target;
    result_.best.cost = known;
  }

  TargetOrder run() {
    Bounds all = search(false);
    // As a rule it costs more if everything else has to leave.
    const TargetBound none(alone_, UnitSet(problem_.units()), task_.target, 0, false);
    if (none.least_if_it_stays(task_.start) < result_.best.cost - kSame) {
      const Bounds other = search(true);
      all = {std::min(all.bound, other.bound), std::min(all.least, other.least), std::min(all.floor, other.floor),
             all.complete && other.complete};
    }
    result_.bound = std::min(all.bound, result_.best.cost);
    result_.least = std::min(all.least, result_.best.cost);
    result_.floor = std::min(all.floor, result_.best.cost);
    result_.complete = all.complete;
    if (result_.best.variants.empty()) result_.best.cost = kForbidden;
    return std::move(result_);
  }

 private:
  struct Bounds {
    double bound = 0, least = 0, floor = 0;
    bool complete = true;
  };

  /// `stays`: everything else may leave instead of the target.
  Bounds search(bool stays) {
    Bounds bounds;
    const double one_step = stays ? 0 : cheapest();
    bounds.least = bounds.floor = one_step;
    if (!stays) leave_at_once(one_step);
    // A cheap order needs few units: what could be in their way is found out step by step.
    bool found_one = false;
    for (double limit = one_step; limit < result_.best.cost - kSame && !found_one;) {
      limit = std::min(limit > 0 ? 2 * limit : kForbidden, result_.best.cost);
      TargetBound lower(alone_, task_.start, task_.target, limit, stays);
      task_.bound = &lower;
      if (const std::vector<VariantId> some = lower.some_order(task_.start); is_feasible(problem_, task_, some)) {
        take(some);
        limit = std::min(limit, result_.best.cost);
      }
      Effort own = share();
      const BestFirst found = best_first(alone_, task_, limit, own);
      give_back(own);
      bounds.least = std::max(bounds.least, found.bound);
      bounds.floor = std::max(bounds.floor, std::min(limit, lower.of(task_.start)));
      bounds.complete = found.complete;
      found_one = !found.best.variants.empty() || !found.complete;
      take(found.best.variants);
    }
    bounds.bound = bounds.least;
    if (found_one && result_.best.cost > bounds.least + kSame) search_all(stays, bounds);
    return bounds;
  }

  /// Nothing is cheaper than one step that costs no more than the target's cheapest one.
  void leave_at_once(double one_step) {
    for (const VariantId v : problem_.variants_of(task_.target))
      if (problem_.leaving(v).size() == 1 && problem_.least(v) <= one_step + kSame &&
          problem_.may_leave(v, task_.start))
        take({v});
  }

  /// By all costs.
  void search_all(bool stays, Bounds& bounds) {
    TargetBound lower(problem_, task_.start, task_.target, result_.best.cost, stays);
    task_.bound = &lower;
    Effort own = share();
    const BestFirst found = best_first(problem_, task_, result_.best.cost, own);
    give_back(own);
    take(found.best.variants);
    bounds.bound = std::max(bounds.bound, found.bound);
    bounds.complete = found.complete;
    if (found.complete) return;
    Effort wide = share();
    const Order other = beam(problem_, task_, wide);
    give_back(wide);
    take(other.variants);
    Order better = result_.best;
    if (better.variants.empty()) return;
    improve(problem_, task_, better, effort_);
    take(better.variants);
  }

  double cheapest() const {
    double least = kForbidden;
    for (const VariantId v : problem_.variants_of(task_.target))
      if (problem_.leaving(v).size() == 1) least = std::min(least, problem_.least(v));
    return least < kForbidden ? least : 0;
  }

  void take(const std::vector<VariantId>& order) {
    if (order.empty()) return;
    const double cost = cost_of(problem_, task_, order);
    if (cost < result_.best.cost - kSame) result_.best = {order, cost};
  }

  Effort share() {
    given_ = effort_.left / 2;
    return {given_, effort_.stop};
  }
  void give_back(const Effort& own) { effort_.left -= given_ - own.left; }

  Problem& problem_;
  Alone alone_;
  Effort& effort_;
  Task task_;
  std::uint64_t given_ = 0;
  TargetOrder result_;
};

}  // namespace

TargetOrder order_to(Problem& problem, const UnitSet& start, std::size_t target, double known, Effort& effort) {
  return Search(problem, start, target, known, effort).run();
}

}  // namespace dismantle::order
