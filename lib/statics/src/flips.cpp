#include "dismantle/statics/flips.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/statics/certificates.h"
#include "dismantle/statics/limits.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kLeastVaried = 1e-5;

std::string_view verb_of(Verdict verdict) {
  return verdict == Verdict::stands ? "it stands" : verdict == Verdict::falls ? "it falls" : "it stands if pressed in";
}

std::string condition_of(const Variant& v) {
  std::string text = v.touching < 1   ? "half the tolerance of contacts"
                     : v.touching > 1 ? "twice the tolerance of contacts"
                                      : "this tolerance of contacts";
  if (v.friction != 1)
    text += fmt::format(" and {:.4g} % {} friction", 100 * std::abs(v.friction - 1), v.friction < 1 ? "less" : "more");
  if (v.tilt != 0)
    text += fmt::format(" and a tilt by {:.3g} degrees about ({:.3g}, {:.3g}, {:.3g})", v.tilt * 180 / M_PI, v.axis.x(),
                        v.axis.y(), v.axis.z());
  return text;
}

}  // namespace

Pile varied(Pile pile, const Variant& variant) {
  for (Contact& c : pile.contacts) c.friction *= variant.friction;
  return variant.tilt == 0 ? pile : tilted(std::move(pile), variant.axis, variant.tilt);
}

std::vector<Variant> flips_of(const Pile& pile, double touching, const std::function<bool()>& stop) {
  const Vec3 u = pile.down.unitOrthogonal(), v = pile.down.cross(u);
  const auto judged = [&](double friction, const Vec3& axis, double tilt) {
    Variant variant{touching, friction, axis, tilt, {}, {}};
    variant.pile = varied(pile, variant);
    variant.judgement = judge(variant.pile, stop);
    return variant;
  };
  for (double by = kLeastVaried; by < 2 * kMostVaried && !(stop && stop()); by *= 10) {
    const double share = std::min(by, kMostVaried);
    std::vector<Variant> near;
    near.push_back(judged(1 - share, Vec3::Zero(), 0));
    near.push_back(judged(1 + share, Vec3::Zero(), 0));
    for (const Vec3& axis : {u, v, Vec3(-u), Vec3(-v)}) near.push_back(judged(1, axis, share));
    for (std::size_t i = 0; i < near.size(); ++i)
      for (std::size_t j = i + 1; j < near.size(); ++j) {
        const Verdict a = near[i].judgement.verdict, b = near[j].judgement.verdict;
        if (a != b && a != Verdict::uncertain && b != Verdict::uncertain)
          return {std::move(near[i]), std::move(near[j])};
      }
  }
  return {};
}

std::string check_judgement(const Pile& pile, const Judgement& judgement) {
  switch (judgement.verdict) {
    case Verdict::stands: {
      std::string wrong = check_equilibrium(pile, judgement.forces);
      return wrong.empty() ? check_created(pile, judgement.forces, judgement.displacement) : wrong;
    }
    case Verdict::falls:
      return check_fall(pile, judgement.motion);
    case Verdict::pressed_in:
      return check_pressed_in(pile, judgement.forces, judgement.others, judgement.slide);
    case Verdict::uncertain:
      break;
  }
  return "nothing is certified: the verdict is uncertain";
}

std::string check_flips(const std::vector<Variant>& variants) {
  for (const Variant& v : variants) {
    // Rounding of sums like 1 + 0.01.
    constexpr double kMost = kMostVaried * (1 + 1e-9);
    if (!(v.touching >= 0.5 && v.touching <= 2 && std::abs(v.friction - 1) <= kMost && std::abs(v.tilt) <= kMost))
      return "a variant differs by more than the stated tolerance";
    if (v.tilt != 0 && !(std::abs(v.axis.norm() - 1) <= 1e-9)) return "the axis of a variant is no unit vector";
    if (std::string wrong = check_judgement(v.pile, v.judgement); !wrong.empty())
      return fmt::format("with {}: {}", condition_of(v), wrong);
  }
  for (const Variant& v : variants)
    if (v.judgement.verdict != variants.front().judgement.verdict) return "";
  return "nothing shows that the verdict changes";
}

std::string flips_text(const std::vector<Variant>& variants) {
  std::string text;
  for (const Variant& v : variants)
    text += fmt::format("{}with {} {}", text.empty() ? "" : ", ", condition_of(v), verb_of(v.judgement.verdict));
  return text;
}

}  // namespace dismantle::statics
