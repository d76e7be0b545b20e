#include "dismantle/statics/stability.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bonds.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/statics/balance.h"
#include "dismantle/statics/budget.h"
#include "dismantle/statics/describe.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kFrictions[] = {0.2, 0.3, 0.4, 0.5, 0.6};
/// Shares of the budget that is left: each of the frictions, each of the tilts, and the least holds. Of the whole:
/// pushes, and what an uncertain verdict changes with.
constexpr double kForFriction = 0.1, kForTilt = 0.15, kForHolds = 0.7, kForPushes = 0.1, kForFlips = 0.5;

/// Contacts of all pairs whose boxes are near, in the input's units.
void add_contacts(const Assembly& assembly, const Bonds& bonds, const std::vector<Shape>& shapes,
                  const StabilityOptions& options, double touching, Pile& pile) {
  std::set<std::pair<PartId, PartId>> clamped;
  for (const std::vector<PartId>& group : bonds.clamped())
    for (const PartId a : group)
      for (const PartId b : group) clamped.emplace(a, b);
  std::vector<Aabb> boxes;
  for (const Shape& s : shapes) {
    boxes.push_back(s.mesh().box());
    boxes.back().inflate(touching * s.radius());
  }
  for (std::uint32_t a = 0; a < shapes.size(); ++a)
    for (std::uint32_t b = a + 1; b < shapes.size(); ++b) {
      if (!boxes[a].overlaps(boxes[b])) continue;
      std::optional<double> bond = bonds.depth(a, b, touching * std::min(shapes[a].radius(), shapes[b].radius()));
      if (!bond && clamped.contains({a, b})) bond = 0;
      for (Contact& c : pair_contacts({&shapes[a], {}}, {&shapes[b], {}}, touching, bond)) {
        c.a = a;
        c.b = b;
        c.friction = options.friction;
        c.bonded = bond.has_value();
        for (Vec3& p : c.points) p = assembly.normalization.to_input(p);
        pile.contacts.push_back(std::move(c));
      }
    }
}

std::vector<PartMove> moves_of(const Pile& pile, const Motions& motion, std::size_t parts) {
  std::vector<PartMove> moves;
  double most = 0;
  for (std::size_t i = 0; i < parts; ++i)
    most = std::max(most, motion[i].v.norm() + motion[i].w.norm() * pile.bodies[i].radius);
  for (std::size_t i = 0; i < parts; ++i) {
    const Motion& m = motion[i];
    if (!(m.v.norm() + m.w.norm() * pile.bodies[i].radius > 1e-3 * most)) continue;
    // A part that turns about its centre: the way of its upper end.
    const Vec3 direction = m.v.norm() > 1e-3 * m.w.norm() * pile.bodies[i].radius ? m.v : Vec3(m.w.cross(-pile.down));
    if (direction.norm() > 0) moves.push_back({static_cast<PartId>(i), direction.normalized()});
  }
  return moves;
}

/// Why parts fall: those for which there is a reason besides what others do; else all that move.
std::vector<std::string> reasons_of(const Pile& pile, const Motions& motion, const Assembly& assembly,
                                    const std::vector<PartMove>& moves) {
  std::vector<std::string> first, others;
  for (const PartMove& m : moves) {
    const std::string why = missing_text(pile, m.part, motion);
    const bool begins = !why.empty() && why != kGivesWay;
    (begins ? first : others)
        .push_back("'" + assembly.parts[m.part].name + "' " +
                   motion_text(pile.bodies[m.part], motion[m.part], pile.down) + (why.empty() ? "" : ": " + why));
  }
  return first.empty() ? others : first;
}

/// Those with certificates, if they differ; otherwise something near one of the others.
std::vector<Variant> flips_between(std::vector<Variant> variants, const Stop& stop) {
  std::vector<Variant> open;
  for (auto at = variants.begin(); at != variants.end();) {
    if (at->judgement.verdict != Verdict::uncertain) {
      ++at;
      continue;
    }
    open.push_back(std::move(*at));
    at = variants.erase(at);
  }
  if (check_flips(variants).empty()) return variants;
  for (const Variant& v : open)
    if (std::vector<Variant> found = flips_of(v.pile, v.touching, stop); !found.empty()) return found;
  return {};
}

bool same_contacts(const Pile& a, const Pile& b) {
  return std::ranges::equal(a.contacts, b.contacts, [](const Contact& x, const Contact& y) {
    return x.a == y.a && x.b == y.b && x.normal == y.normal && x.points == y.points && x.friction == y.friction &&
           x.bonded == y.bonded;
  });
}

/// Verdicts of piles of the same bodies.
class Verdicts {
 public:
  /// What is certified of a similar pile is tried first. That a pile is pressed in is not all in its certificate.
  Judgement of(const Pile& pile, const Stop& stop) {
    for (const auto& [other, judgement] : known_) {
      if (same_contacts(pile, other)) return judgement;
      const bool proved = judgement.verdict == Verdict::stands || judgement.verdict == Verdict::falls;
      if (proved && check_judgement(pile, judgement).empty()) return judgement;
    }
    Judgement found = judge(pile, stop);
    if (!(stop && stop())) known_.emplace_back(pile, found);
    return found;
  }

 private:
  std::vector<std::pair<Pile, Judgement>> known_;
};

/// The answers beside the verdict, within a budget.
class Answers {
 public:
  Answers(const AssemblyPile& assembly, StabilityReport& report, Verdicts& verdicts, double work, const Stop& stop)
      : assembly_(assembly),
        report_(report),
        pile_(report.pile),
        verdicts_(verdicts),
        budget_(work),
        for_pushes_(kForPushes * work),
        stop_(stop) {}

  void find() {
    find_frictions();
    if (report_.judgement.verdict == Verdict::stands) {
      report_.holds.found = report_.holds.proved = true;
      find_tilts();
      find_pushes();
    } else {
      for (TiltLimit& tilt : report_.tilts) tilt.angle = 0;
      find_holds();
      find_moves();
    }
  }

 private:
  /// Takes a share of what is left; `find(stop)` ends when it is used up. False: it did.
  template <class Find>
  bool within(double share, const Find& find) {
    return within_work(share * budget_.left(), find);
  }
  template <class Find>
  bool within_work(double work, const Find& find) {
    const Budget part(std::min(work, budget_.left()));
    find([&] { return part.spent() || (stop_ && stop_()); });
    return !part.spent();
  }

  void find_frictions() {
    report_.by_friction.assign(std::size(kFrictions), {});
    std::vector<std::size_t> order;  // those near the stated one first: their certificates may do for the others
    for (std::size_t i = 0; i < std::size(kFrictions); ++i) {
      report_.by_friction[i].first = kFrictions[i];
      order.push_back(i);
    }
    const double own = assembly_.options().friction;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::abs(kFrictions[i] - own); });
    for (const std::size_t i : order) {
      Pile other = pile_;
      for (Contact& c : other.contacts) c.friction = kFrictions[i];
      Verdict verdict = Verdict::uncertain;
      if (within(kForFriction, [&](const Stop& stop) { verdict = verdicts_.of(other, stop).verdict; }))
        report_.by_friction[i].second = verdict;
      else
        report_.not_computed.push_back(fmt::format("friction {:.1f}", kFrictions[i]));
    }
  }

  void find_tilts() {
    for (std::size_t i = 0; i < kTiltAxes.size(); ++i) {
      const Vec3 axis = (i < 2 ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(i % 2));
      TiltLimit& tilt = report_.tilts[i];
      within(kForTilt, [&](const Stop& stop) { tilt = tilt_limit(pile_, axis, report_.judgement.displacement, stop); });
      if (!tilt.found) report_.not_computed.push_back(fmt::format("critical tilt about {}", kTiltAxes[i]));
    }
  }

  /// Of one body after the other; first those that a small push moves even if all others are held. Where the budget is
  /// spent that push is an upper bound.
  void find_pushes() {
    std::vector<std::pair<std::uint32_t, std::optional<LeastPush>>> bodies;
    std::size_t left = 0;
    for (const Body& b : pile_.bodies) left += b.fixed ? 0 : 1;
    const std::size_t all = left;
    within_work(for_pushes_, [&](const Stop& stop) {
      const Motions rest = balance(pile_, FrictionLaw::associated, stop).displacement;
      for (std::uint32_t i = 0; i < pile_.bodies.size(); ++i) {
        if (pile_.bodies[i].fixed) continue;
        std::optional<LeastPush> alone = least_push_alone(pile_, i, stop);
        if (stop()) break;
        bodies.emplace_back(i, std::move(alone));
      }
      std::ranges::stable_sort(bodies, {}, [](const auto& b) {
        return b.second ? b.second->force : std::numeric_limits<double>::infinity();
      });
      for (auto& [body, bound] : bodies) {
        std::optional<LeastPush> push = least_push(pile_, body, stop, rest, bound);
        if (stop()) break;
        --left;
        bound = std::move(push);
      }
    });
    for (auto& [body, push] : bodies)
      if (push) report_.pushes.push_back(std::move(*push));
    if (left > 0) report_.not_computed.push_back(fmt::format("least push on {} of {} parts", left, all));
    std::ranges::stable_sort(report_.pushes, {}, &LeastPush::body);
    std::ranges::stable_sort(report_.pushes, {}, &LeastPush::force);
  }

  void find_holds() {
    if (within(kForHolds, [&](const Stop& stop) { report_.holds = least_holds(pile_, stop); })) return;
    report_.holds = {};
    report_.not_computed.emplace_back("holds");
  }

  void find_moves() {
    Balance sliding;                                                           // friction as it is, for people
    const bool pressed_in = report_.judgement.verdict == Verdict::pressed_in;  // it is known
    if (pressed_in || !within(1, [&](const Stop& stop) { sliding = balance(pile_, FrictionLaw::coulomb, stop); }))
      sliding = {};
    const Motions& motion = sliding.falling.empty() ? report_.judgement.motion : sliding.falling;
    if (motion.empty()) return;
    report_.moves = moves_of(pile_, motion, assembly_.options().fixed.size());
    report_.why = reasons_of(pile_, motion, assembly_.assembly(), report_.moves);
    report_.falling = motion;
  }

  const AssemblyPile& assembly_;
  StabilityReport& report_;
  const Pile& pile_;
  Verdicts& verdicts_;
  Budget budget_;
  double for_pushes_;
  const Stop& stop_;
};

}  // namespace

AssemblyPile::AssemblyPile(const Assembly& assembly, StabilityOptions options)
    : assembly_(assembly), options_(std::move(options)) {
  options_.fixed.resize(assembly.parts.size(), false);
  options_.mass.resize(assembly.parts.size());
  if (options_.density.empty())
    for (const Part& p : assembly.parts) options_.density.push_back(p.density.value_or(1));
  for (const Part& p : assembly.parts) shapes_.emplace_back(*p.mesh);
  bonds_ = std::make_unique<const Bonds>(assembly);
}

AssemblyPile::~AssemblyPile() = default;

bool AssemblyPile::unit_known() const { return !assembly_.unit.empty(); }

Pile AssemblyPile::pile(double factor) const {
  const double touching = factor * options_.touching, scale = assembly_.normalization.scale;
  const double metre = metres_in(unit_known() ? assembly_.unit : "mm");
  Pile pile;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const Shape& s = shapes_[i];
    const double volume = s.volume() > 0 ? s.volume() : assembly_.parts[i].volume;
    double kg = options_.density[i] * 1000 * volume * std::pow(metre / scale, 3);
    if (options_.mass[i]) kg = *options_.mass[i];
    if (!(kg > 0)) kg = 1e-6;  // an open surface: it weighs next to nothing
    pile.bodies.push_back({kg * kGravity, assembly_.normalization.to_input(s.center()), s.radius() / scale,
                           static_cast<bool>(options_.fixed[i])});
  }
  add_contacts(assembly_, *bonds_, shapes_, options_, touching, pile);
  pile.down = -options_.up;
  if (options_.table) {
    const std::uint32_t table = static_cast<std::uint32_t>(pile.bodies.size());
    pile.bodies.push_back({0, Vec3::Zero(), 1, true});
    double height = std::numeric_limits<double>::infinity();
    for (const Shape& s : shapes_) height = std::min(height, lowest({&s, {}}, options_.up));
    for (std::uint32_t i = 0; i < table; ++i) {
      Contact c = contact_with_table({&shapes_[i], {}}, options_.up, height, touching);
      if (c.points.empty()) continue;
      c.a = i;
      c.b = table;
      c.friction = options_.friction;
      for (Vec3& p : c.points) p = assembly_.normalization.to_input(p);
      pile.contacts.push_back(std::move(c));
    }
  }
  for (const auto& [axis, angle] : options_.tilts) pile = tilted(std::move(pile), axis, angle);
  return pile;
}

StabilityReport judge_assembly(const AssemblyPile& assembly, const Stop& stop, double work) {
  StabilityReport report;
  report.pile = assembly.pile();
  Verdicts verdicts;
  report.judgement = verdicts.of(report.pile, stop);
  const Verdict verdict = report.judgement.verdict;
  std::vector<Variant> variants;
  for (const double factor : {0.5, 1.0, 2.0}) {
    Variant v;
    v.touching = factor;
    v.pile = factor == 1 ? report.pile : assembly.pile(factor);
    v.judgement = verdicts.of(v.pile, stop);
    report.at_tolerances.push_back(v.judgement.verdict);
    variants.push_back(std::move(v));
  }
  const Budget budget(work);
  const bool differs = std::ranges::any_of(report.at_tolerances, [&](Verdict v) { return v != verdict; });
  if (differs || verdict == Verdict::uncertain) {
    const Budget part(kForFlips * work);
    const Stop enough = [&] { return part.spent() || (stop && stop()); };
    report.variants = flips_between(std::move(variants), enough);
    if (report.variants.empty() && part.spent()) report.not_computed.emplace_back("what the verdict changes with");
  } else {
    variants.erase(variants.begin() + 1);
    report.variants = std::move(variants);
  }
  Answers(assembly, report, verdicts, budget.left(), stop).find();
  if (differs) report.judgement.verdict = Verdict::uncertain;
  return report;
}

}  // namespace dismantle::statics
