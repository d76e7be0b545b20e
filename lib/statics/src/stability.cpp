#include "dismantle/statics/stability.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bonds.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/statics/balance.h"
#include "dismantle/statics/describe.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kFrictions[] = {0.2, 0.3, 0.4, 0.5, 0.6};
constexpr std::size_t kMostPushed = 60;  // parts: sixteen directions for each of them

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

StabilityReport judge_assembly(const AssemblyPile& assembly, const Stop& stop) {
  StabilityReport report;
  report.pile = assembly.pile();
  Pile& pile = report.pile;
  report.judgement = judge(pile, stop);
  const Verdict verdict = report.judgement.verdict;
  std::vector<Variant> variants;
  for (const double factor : {0.5, 1.0, 2.0}) {
    Variant v;
    v.touching = factor;
    v.pile = factor == 1 ? pile : assembly.pile(factor);
    v.judgement = factor == 1 ? report.judgement : judge(v.pile, stop);
    report.at_tolerances.push_back(v.judgement.verdict);
    variants.push_back(std::move(v));
  }
  for (const double friction : kFrictions) {
    Pile other = pile;
    for (Contact& c : other.contacts) c.friction = friction;
    report.by_friction.emplace_back(friction, judge(other, stop).verdict);
  }
  if (verdict == Verdict::stands) {
    report.holds.found = report.holds.proved = true;
    report.tilt_x = critical_tilt(pile, Vec3::UnitX(), stop);
    report.tilt_y = critical_tilt(pile, Vec3::UnitY(), stop);
    report.tilt_back_x = critical_tilt(pile, -Vec3::UnitX(), stop);
    report.tilt_back_y = critical_tilt(pile, -Vec3::UnitY(), stop);
    std::size_t loose = 0;
    for (const Body& b : pile.bodies) loose += !b.fixed;
    report.pushes_left_out = loose > kMostPushed;
    for (std::uint32_t i = 0; i < pile.bodies.size() && !report.pushes_left_out; ++i)
      if (!pile.bodies[i].fixed)
        if (auto push = least_push(pile, i, stop)) report.pushes.push_back(std::move(*push));
    std::stable_sort(report.pushes.begin(), report.pushes.end(),
                     [](const LeastPush& a, const LeastPush& b) { return a.force < b.force; });
  } else {
    report.tilt_x = report.tilt_y = report.tilt_back_x = report.tilt_back_y = 0;
    report.holds = least_holds(pile, stop);
    const Balance sliding = balance(pile, FrictionLaw::coulomb, stop);  // friction as it is, for people
    const Motions& motion = sliding.falling.empty() ? report.judgement.motion : sliding.falling;
    if (!motion.empty()) {
      report.moves = moves_of(pile, motion, assembly.options().fixed.size());
      report.why = reasons_of(pile, motion, assembly.assembly(), report.moves);
      report.falling = motion;
    }
  }
  if (std::any_of(report.at_tolerances.begin(), report.at_tolerances.end(), [&](Verdict v) { return v != verdict; }))
    report.judgement.verdict = Verdict::uncertain;
  if (report.judgement.verdict == Verdict::uncertain) {
    report.variants = flips_between(std::move(variants), stop);
  } else {
    variants.erase(variants.begin() + 1);
    report.variants = std::move(variants);
  }
  return report;
}

}  // namespace dismantle::statics
