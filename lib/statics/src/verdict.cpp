#include "dismantle/statics/verdict.h"

#include <Eigen/Geometry>
#include <utility>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"

namespace dismantle::statics {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::stands:
      return "stands";
    case Verdict::falls:
      return "falls";
    case Verdict::pressed_in:
      return "pressed_in";
    case Verdict::uncertain:
      break;
  }
  return "uncertain";
}

Judgement judge_forces(const Pile& pile, const std::function<bool()>& stop) {
  Balance any = balance(pile, FrictionLaw::associated, stop);
  if (any.balanced && check_equilibrium(pile, any.forces).empty())
    return {Verdict::stands, std::move(any.forces), {}, {}};
  if (!any.balanced && check_fall(pile, any.falling).empty()) return {Verdict::falls, {}, {}, std::move(any.falling)};
  return {};
}

Judgement judge(const Pile& pile, const std::function<bool()>& stop) {
  Balance any = balance(pile, FrictionLaw::associated, stop);
  if (!any.balanced && check_fall(pile, any.falling).empty()) return {Verdict::falls, {}, {}, std::move(any.falling)};
  Balance created = balance(pile, FrictionLaw::coulomb, stop);
  if (created.balanced && check_equilibrium(pile, created.forces).empty() &&
      check_created(pile, created.forces, created.displacement).empty())
    return {Verdict::stands, std::move(created.forces), std::move(created.displacement), {}};
  if (any.balanced && !created.balanced && check_equilibrium(pile, any.forces).empty() && !(stop && stop()))
    return {Verdict::pressed_in, std::move(any.forces), {}, std::move(created.falling)};
  return {};
}

}  // namespace dismantle::statics
