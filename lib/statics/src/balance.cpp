#include "dismantle/statics/balance.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "dismantle/statics/certificates.h"
#include "springs.h"

namespace dismantle::statics {
namespace {

constexpr double kBalanced = 1e-6;
constexpr unsigned kFewSteps = 25;  // of Newton's method: the next program may be harder
/// Coulomb: what moves on by the same length in this many steps, up to this share, falls. At this rate it would not
/// come to rest in all the steps that there are.
constexpr int kSteadySteps = 8;
constexpr double kSteady = 0.02;

Balance result_of(const Springs& springs, const Eigen::VectorXd& anchor, bool balanced) {
  Balance result{balanced, springs.residual(anchor), springs.forces(), springs.motion_of(springs.at()),
                 {},       springs.factorizations()};
  if (!balanced) result.falling = springs.motion_of(springs.at() - anchor);
  return result;
}

Balance associated(Springs& springs, const std::function<bool()>& stop) {
  Eigen::VectorXd anchor = springs.at();
  for (int k = 0; k < 40; ++k) {
    anchor = springs.at();
    const unsigned before = springs.factorizations();
    if (!springs.minimize(anchor, stop)) {
      if (stop && stop()) break;
      if (!springs.shorten_steps()) break;
      continue;
    }
    if (springs.residual(anchor) < kBalanced) return result_of(springs, anchor, true);
    if (check_fall(springs.pile(), springs.motion_of(springs.at() - anchor)).empty()) break;
    if (springs.factorizations() - before <= kFewSteps) springs.lengthen_steps();
  }
  return result_of(springs, anchor, false);
}

/// `steady`: ended with a fall whose speed does not change any more.
Balance coulomb(Springs& springs, bool& steady, const std::function<bool()>& stop) {
  Eigen::VectorXd anchor = springs.at();
  double best = 1e300, share = 1, enough = kBalanced;
  int since = 0;
  steady = false;
  std::deque<double> residuals;  // of the last steps
  for (int k = 0; k < 200; ++k) {
    anchor = springs.at();
    const unsigned before = springs.factorizations();
    springs.minimize(anchor, stop);  // a step that did not converge is a step nevertheless
    if (stop && stop()) break;
    const double residual = springs.residual(anchor), change = springs.update_limits(share);
    const double worst = std::max(residual, change);
    if (worst < enough) {
      if (springs.solve_coupled(stop)) return result_of(springs, springs.at(), true);
      springs.update_limits();
      Balance found = result_of(springs, anchor, true);
      if (worst < 1e-3 * kBalanced || is_certified(springs.pile(), found)) return found;
      enough = 0.3 * worst;
    }
    residuals.push_front(residual);
    if (residuals.size() > static_cast<std::size_t>(kSteadySteps)) {
      steady = since > kSteadySteps && residual > change && std::abs(residuals.back() - residual) < kSteady * residual;
      if (steady) break;
      residuals.pop_back();
    }
    if (k % 4 == 2 && springs.solve_coupled(stop)) return result_of(springs, springs.at(), true);
    // Long chains give way far: the proximal term alone holds them back.
    if (residual > change && springs.factorizations() - before <= kFewSteps) springs.lengthen_steps();
    if (worst < 0.9 * best) {
      best = worst;
      since = 0;
    } else if (++since > 40) {
      break;
    } else if (since % 4 == 0) {
      share = std::max(0.1, 0.7 * share);
    }
  }
  return result_of(springs, anchor, false);
}

}  // namespace

bool is_certified(const Pile& pile, const Balance& by) {
  return by.balanced && check_equilibrium(pile, by.forces).empty() &&
         check_created(pile, by.forces, by.displacement).empty();
}

Balance balance(const Pile& pile, FrictionLaw law, const std::function<bool()>& stop, const Motions& near) {
  Springs springs(pile, law);
  if (springs.size() == 0) return result_of(springs, springs.at(), true);
  if (law == FrictionLaw::associated) {
    if (!near.empty()) springs.start_at(springs.point_of(near));
    return associated(springs, stop);
  }
  if (!near.empty())
    if (std::optional<Balance> warm = balance_near(pile, near, stop)) return std::move(*warm);
  bool steady = false;
  Balance found = coulomb(springs, steady, stop);
  if (!springs.is_long() || steady || is_certified(pile, found) || (stop && stop())) return found;
  // A long chain gives way far: once more from the displacement of the associated law, which lies nearer.
  Springs any(pile, FrictionLaw::associated);
  if (!associated(any, stop).balanced) return found;
  Springs again(pile, law);
  again.start_at(any.at());
  if (again.solve_coupled(stop))
    if (Balance second = result_of(again, again.at(), true); is_certified(pile, second)) return second;
  Balance second = coulomb(again, steady, stop);
  return is_certified(pile, second) ? second : found;
}

std::optional<Balance> balance_near(const Pile& pile, const Motions& near, const std::function<bool()>& stop) {
  Springs springs(pile, FrictionLaw::coulomb);
  springs.start_at(springs.point_of(near));
  if (!springs.solve_coupled(stop)) return std::nullopt;
  Balance found = result_of(springs, springs.at(), true);
  return is_certified(pile, found) ? std::optional(std::move(found)) : std::nullopt;
}

double work_done() { return Springs::work_done(); }

}  // namespace dismantle::statics
