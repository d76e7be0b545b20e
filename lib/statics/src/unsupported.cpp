// How many bodies do not stand even if all others are held: the estimate that searches for orders ask for.
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "dismantle/statics/built.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

std::size_t BuiltPiles::unsupported(std::span<const PlacedPart> parts, std::span<const PlacedPart> of,
                                    const Vec3& up) const {
  const std::vector<const PlacedPart*> there = places(parts);
  const double lowest = bottom_of(parts, up);
  bool all_in_place = true;  // as assembled, relative to each other
  for (const PlacedPart& p : parts) {
    if (!all_in_place || p.pose == parts.front().pose) continue;
    all_in_place = in_place(p, parts.front());
  }
  std::vector<bool> seen(meshes_.size(), false);
  std::size_t count = 0;
  for (const PlacedPart& first : of) {
    if (seen[first.part]) continue;
    std::vector<PlacedPart> body{first}, near;
    seen[first.part] = true;
    const auto add = [&](PartId part) {
      if (!seen[part]) body.push_back(*there[part]);
      seen[part] = true;
    };
    for (std::size_t i = 0; i < body.size(); ++i) {
      for (const std::size_t k : clamped_of_[body[i].part])
        if (is_clamped(clamped_[k], there)) std::ranges::for_each(clamped_[k], add);
      for (const Neighbour& n : neighbours_[body[i].part]) {
        const PlacedPart* other = there[n.part];
        if (other == nullptr || seen[n.part] || !n.bond) continue;
        if (!one_unit(body[i].part, n.part) &&
            (all_in_place ? contacts_at(body[i].part, n.part, Gaps::tight, {})->empty()
                          : contacts(body[i], *other, Gaps::tight).empty()))
          continue;
        add(n.part);
      }
    }
    const auto by_part = [](const PlacedPart& x, const PlacedPart& y) { return x.part < y.part; };
    std::sort(body.begin(), body.end(), by_part);
    // What may touch it, in the order of `parts`.
    std::vector<const PlacedPart*> close;
    if (all_in_place) {
      for (const PlacedPart& p : body)
        for (const Neighbour& n : neighbours_[p.part])
          if (there[n.part] != nullptr) close.push_back(there[n.part]);
      std::sort(close.begin(), close.end());
      close.erase(std::unique(close.begin(), close.end()), close.end());
    } else {
      for (const PlacedPart& p : parts) close.push_back(&p);
    }
    for (const PlacedPart* p : close)
      if (!std::binary_search(body.begin(), body.end(), *p, by_part)) near.push_back(*p);
    const double own = bottom_of(body, up);
    double above = std::max(0.0, own - lowest);
    if (above > touching(Gaps::play) * size_) above = size_;  // far from the table
    count += stands(std::move(body), std::move(near), up, own - above, all_in_place) ? 0 : 1;
  }
  return count;
}

bool BuiltPiles::stands(std::vector<PlacedPart> body, std::vector<PlacedPart> near, Vec3 up, double table,
                        bool in_place) const {
  const auto either = [&] {
    return stands_on(body, near, up, table, Gaps::tight) || stands_on(body, near, up, table, Gaps::play);
  };
  if (!in_place) return either();
  // The answer is kept. It is found in the frame of the assembly, so that it does not depend on who asks first.
  // What stands on the table alone stands next to others: these are held here, and can only help. A base plate is asked
  // about once, not for each set of its hundreds of neighbours.
  if (!near.empty() && bottom_of(body, up) - table < size_ && stands(body, {}, up, table, true)) return true;
  const double above = bottom_of(body, up) - table;
  up = body.front().pose.q.conjugate() * up;
  std::vector<double> key{up.x(), up.y(), up.z(), above};
  for (PlacedPart& p : body) {
    p.pose = {};
    key.push_back(p.part);
  }
  key.push_back(-1);
  for (PlacedPart& p : near) {
    p.pose = {};
    key.push_back(p.part);
  }
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = alone_.find(key); known != alone_.end()) return known->second;
  }
  table = bottom_of(body, up) - above;
  const bool found = either();
  const std::lock_guard lock(mutex_);
  return alone_.emplace(std::move(key), found).first->second;
}

bool BuiltPiles::stands_on(std::span<const PlacedPart> unit, std::span<const PlacedPart> near, const Vec3& up,
                           double table, Gaps gaps) const {
  Body whole{0, Vec3::Zero(), 0, false};
  std::vector<Body> bodies;
  for (const PlacedPart& p : unit) {
    bodies.push_back(body(p));
    const Body& b = bodies.back();
    if (b.fixed) return true;
    whole.center = (whole.weight * whole.center + b.weight * b.center) / (whole.weight + b.weight);
    whole.weight += b.weight;
  }
  for (const Body& b : bodies) whole.radius = std::max(whole.radius, b.radius + (b.center - whole.center).norm());
  BuiltPile built{{{whole, {0, Vec3::Zero(), 1, true}}, {}, -up}, std::vector<std::uint32_t>(unit.size(), 0)};
  for (const PlacedPart& p : unit)
    for (const PlacedPart& other : near)
      for (Contact& c : contacts(p, other, gaps)) {
        if (bonded(p.part, other.part)) return true;
        c.a = 0;
        c.b = 1;
        built.pile.contacts.push_back(std::move(c));
      }
  add_table(unit, table, up, gaps, built);
  return judge(built.pile).verdict == Verdict::stands;
}

}  // namespace dismantle::statics
