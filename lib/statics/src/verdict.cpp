#include "dismantle/statics/verdict.h"

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"
#include "squeeze.h"

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

Judgement judge_forces(const Pile& pile, const std::function<bool()>& stop, const Motions& near) {
  Balance any = balance(pile, FrictionLaw::associated, stop, near);
  if (any.balanced && check_equilibrium(pile, any.forces).empty())
    return {Verdict::stands, std::move(any.forces), std::move(any.displacement), {}};
  if (!any.balanced && check_fall(pile, any.falling).empty()) return {Verdict::falls, {}, {}, std::move(any.falling)};
  return {};
}

Judgement judge(const Pile& pile, const std::function<bool()>& stop, const Motions& near) {
  Balance any = balance(pile, FrictionLaw::associated, stop, near);
  if (!any.balanced && check_fall(pile, any.falling).empty()) return {Verdict::falls, {}, {}, std::move(any.falling)};
  const auto stands = [&](Balance& by) -> std::optional<Judgement> {
    if (!by.balanced || !check_equilibrium(pile, by.forces).empty() ||
        !check_created(pile, by.forces, by.displacement).empty())
      return std::nullopt;
    return Judgement{Verdict::stands, std::move(by.forces), std::move(by.displacement), {}};
  };
  // Where nothing slides, or slides on what presses, the associated law is Coulomb's.
  if (auto judged = stands(any)) return std::move(*judged);
  Balance created = balance(pile, FrictionLaw::coulomb, stop, near);
  if (auto judged = stands(created)) return std::move(*judged);
  if (!any.balanced || (stop && stop())) return {};
  Balance slide = balance(without_friction(pile), FrictionLaw::associated, stop);
  if (auto judged = stands(slide)) return std::move(*judged);  // pressure alone carries it
  if (created.balanced || slide.balanced) return {};
  ContactForces others = squeezed_forces(pile, any.forces, created.falling, stop);
  if (!check_pressed_in(pile, any.forces, others, slide.falling).empty()) return {};
  return {Verdict::pressed_in,        std::move(any.forces), {},
          std::move(created.falling), std::move(others),     std::move(slide.falling)};
}

bool is_pressed_in(const Pile& pile, const Judgement& by_forces, const std::function<bool()>& stop) {
  return !check_created(pile, by_forces.forces, by_forces.displacement).empty() &&
         judge(pile, stop).verdict == Verdict::pressed_in;
}

}  // namespace dismantle::statics
