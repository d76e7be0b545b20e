#include "dismantle/statics/hands_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "dismantle/statics/certificates.h"
#include "dismantle/statics/step_proof.h"
#include "dismantle/statics/verdict.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Parts = std::vector<PlacedPart>;

constexpr double kSameUp = 1e-9;  // 1 - cosine
constexpr std::size_t kEnough = 2;

struct Units {
  std::vector<Parts> parts;              // by unit, as assembled
  std::vector<Vec3> ups;                 // that the steps have
  std::vector<std::vector<double>> low;  // by orientation and unit: its lowest point
};

/// None: the operations do not put one unit after the other to the same group, each as assembled.
std::optional<Units> units_of(const BuiltPiles& piles, std::span<const StepQuestion> operations) {
  Units units;
  Parts there;
  const auto add = [&](std::span<const PlacedPart> placed) {
    if (placed.empty()) return;
    units.parts.push_back(joined(placed, {}));
    for (PlacedPart& p : units.parts.back()) p.pose = {};
    there = joined(there, units.parts.back());
  };
  for (const StepQuestion& q : operations) {
    if (&q == operations.data()) add(q.present);
    const Parts present = where_assembled(joined(q.present, {})), all = where_assembled(joined(q.present, q.moving));
    if (present.size() != there.size() || !std::equal(present.begin(), present.end(), there.begin(),
                                                      [](const auto& a, const auto& b) { return a.part == b.part; }))
      return std::nullopt;
    for (const PlacedPart& p : all)
      if (!p.pose.t.isZero(0) || !p.pose.q.vec().isZero(0)) return std::nullopt;
    add(q.moving);
    if (std::none_of(units.ups.begin(), units.ups.end(), [&](const Vec3& up) { return up.dot(q.up) > 1 - kSameUp; }))
      units.ups.push_back(q.up);
  }
  // The same for each order of them.
  std::ranges::sort(units.parts, {}, [](const Parts& parts) { return parts.front().part; });
  std::ranges::sort(units.ups, {}, [](const Vec3& up) { return std::tuple(up.x(), up.y(), up.z()); });
  for (const Vec3& up : units.ups) {
    units.low.emplace_back();
    for (const Parts& p : units.parts) units.low.back().push_back(piles.bottom(p, up));
  }
  return units;
}

/// Units that reach the table in some orientation.
std::vector<bool> lowest(const Units& units, double gap) {
  std::vector<bool> is_low(units.parts.size(), false);
  for (const std::vector<double>& low : units.low)
    for (std::size_t u = 0; u < low.size(); ++u)
      if (low[u] <= *std::min_element(low.begin(), low.end()) + gap) is_low[u] = true;
  return is_low;
}

Parts parts_of(const Units& units, const std::vector<bool>& base) {
  Parts parts;
  for (std::size_t u = 0; u < base.size(); ++u)
    if (base[u]) parts = joined(parts, units.parts[u]);
  return parts;
}

/// The unit among others that are held. It does not touch the table.
Pile resting(const BuiltPiles& piles, const Parts& unit, const Parts& held, const Vec3& up, Gaps gaps) {
  const Parts all = joined(held, unit);
  BuiltPile built = piles.pile(all, up, gaps, false);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::none_of(unit.begin(), unit.end(), [&](const PlacedPart& p) { return p.part == all[i].part; }))
      built.pile.bodies[built.body_of[i]].fixed = true;
  return std::move(built.pile);
}

/// Appends the motions of falling of a unit. False: in some orientation it may stand.
bool add_falls(const BuiltPiles& piles, const Units& units, const Parts& held, std::size_t unit,
               std::vector<double>& falls) {
  for (const Vec3& up : units.ups) {
    const auto pile = [&](Gaps gaps) { return resting(piles, units.parts[unit], held, up, gaps); };
    const Judgement found = judge_forces(pile(Gaps::play));
    if (found.verdict != Verdict::falls || !check_fall(pile(Gaps::tight), found.motion).empty()) return false;
    add_fall(found.motion, falls);
  }
  return true;
}

}  // namespace

HandsBound least_hands(const BuiltPiles& piles, std::span<const StepQuestion> operations) {
  const std::optional<Units> units = units_of(piles, operations);
  if (!units) return {};
  const std::size_t count = units->parts.size();
  std::vector<bool> base = lowest(*units, piles.gap(Gaps::play));
  const auto may_stand = [&](const Parts& unit) {
    const Parts all = joined(parts_of(*units, base), unit);
    return std::any_of(units->ups.begin(), units->ups.end(),
                       [&](const Vec3& up) { return piles.unsupported(all, unit, up) == 0; });
  };
  std::vector<double> falls;
  for (bool all_fall = false; !all_fall;) {
    for (bool more = true; more;) {
      more = false;
      for (std::size_t u = 0; u < count; ++u)
        if (!base[u] && may_stand(units->parts[u])) base[u] = more = true;
    }
    if (std::count(base.begin(), base.end(), false) < static_cast<std::ptrdiff_t>(kEnough)) return {};
    falls.clear();
    all_fall = true;
    const Parts held = parts_of(*units, base);
    for (std::size_t u = 0; u < count && all_fall; ++u)
      if (!base[u] && !add_falls(piles, *units, held, u, falls)) {
        base[u] = true;
        all_fall = false;
      }
  }
  HandsBound bound;
  bound.hands = kEnough;
  for (std::size_t u = 0; u < count; ++u)
    if (base[u]) {
      ++bound.others;
    } else {
      bound.loose.push_back(units->parts[u].front().part);
      bound.numbers["loose"].push_back(static_cast<double>(u));
    }
  bound.numbers["falls"] = std::move(falls);
  return bound;
}

std::string check_least_hands(const BuiltPiles& piles, std::span<const StepQuestion> operations,
                              const Numbers& numbers) {
  const std::optional<Units> units = units_of(piles, operations);
  if (!units) return "the plan does not put one unit after the other to the same group";
  const auto loose = numbers.find("loose"), falls = numbers.find("falls");
  if (loose == numbers.end() || falls == numbers.end()) return "its numbers are not those of such a proof";
  const std::vector<bool> on_table = lowest(*units, piles.gap(Gaps::play));
  std::vector<bool> base(units->parts.size(), true);
  double before = -1;
  for (const double u : loose->second) {
    if (!(u > before) || !(u < static_cast<double>(base.size())) || u != std::floor(u)) return "there is no such unit";
    if (on_table[static_cast<std::size_t>(u)]) return fmt::format("unit {} reaches the table", u);
    base[static_cast<std::size_t>(u)] = false;
    before = u;
  }
  if (loose->second.size() < kEnough) return "the last unit may be the only one that falls";
  const Parts held = parts_of(*units, base);
  std::size_t at = 0;
  for (std::size_t u = 0; u < base.size(); ++u)
    for (std::size_t k = 0; !base[u] && k < units->ups.size(); ++k) {
      std::optional<Motions> motion;
      for (const Gaps gaps : {Gaps::play, Gaps::tight}) {
        const Pile pile = resting(piles, units->parts[u], held, units->ups[k], gaps);
        if (!motion) motion = fall_at(falls->second, at, pile.bodies.size());
        if (!motion) return "its motions of falling are not those of such piles";
        if (const std::string wrong = check_fall(pile, *motion); !wrong.empty())
          return fmt::format("unit {}: {}", u, wrong);
      }
    }
  return at == falls->second.size() ? "" : "it has more motions than there are piles";
}

}  // namespace dismantle::statics
