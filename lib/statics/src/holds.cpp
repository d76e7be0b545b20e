#include "dismantle/statics/holds.h"

#include <algorithm>
#include <map>
#include <optional>

#include "dismantle/geometry/disjoint_sets.h"

namespace dismantle::statics {
namespace {

using Group = std::vector<std::uint32_t>;
using Stop = std::function<bool()>;
using Judge = Judgement (*)(const Pile& pile, const Stop& stop);

constexpr int kRounds = 400;

bool contains(const Group& group, std::uint32_t body) {
  return std::find(group.begin(), group.end(), body) != group.end();
}

Pile held(Pile pile, const Group& bodies) {
  for (const std::uint32_t i : bodies) pile.bodies[i].fixed = true;
  return pile;
}

/// The verdict of `group` when everything outside of it is held, which is one fixed body then.
Verdict verdict_alone(const Pile& pile, const Group& group, Judge judged, const Stop& stop) {
  Pile alone;
  alone.down = pile.down;
  constexpr std::uint32_t kHeld = 0;
  alone.bodies.push_back({0, Eigen::Vector3d::Zero(), 1, true});
  std::vector<std::uint32_t> number(pile.bodies.size(), kHeld);
  for (const std::uint32_t i : group) {
    number[i] = static_cast<std::uint32_t>(alone.bodies.size());
    alone.bodies.push_back(pile.bodies[i]);
  }
  for (Contact c : pile.contacts) {
    c.a = number[c.a];
    c.b = number[c.b];
    if (c.a != kHeld || c.b != kHeld) alone.contacts.push_back(std::move(c));
  }
  for (Push p : pile.pushes)
    if (number[p.body] != kHeld) {
      p.body = number[p.body];
      alone.pushes.push_back(p);
    }
  return judged(alone, stop).verdict;
}

/// Everything outside of `group` is held, and still it does not stand.
bool must_be_hit(const Pile& pile, const Group& group, Judge judged, const Stop& stop) {
  return verdict_alone(pile, group, judged, stop) != Verdict::stands;
}

/// A group of which no part can be left out; halves are tried before single bodies. What falls stays so: only falling
/// is proved.
Group smallest(const Pile& pile, Group group, Judge judged, const Stop& stop) {
  const bool falls = verdict_alone(pile, group, judged, stop) == Verdict::falls;
  const auto will_do = [&](const Group& less) {
    const Verdict verdict = verdict_alone(pile, less, judged, stop);
    return verdict == Verdict::falls || (!falls && verdict != Verdict::stands);
  };
  for (std::size_t size = group.size() / 2; size > 0; size /= 2)
    for (std::size_t first = 0; first < group.size() && group.size() > 1;) {
      Group without = group;
      const auto begin = without.begin() + static_cast<std::ptrdiff_t>(first);
      without.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(size, group.size() - first)));
      if (!without.empty() && will_do(without))
        group = std::move(without);
      else
        first += size;
    }
  return group;
}

/// Extends `chosen` to a set of at most `most` bodies that meets all groups.
bool extend(const std::vector<Group>& groups, std::size_t most, Group& chosen) {
  const Group* open = nullptr;
  for (const Group& g : groups) {
    if (std::any_of(g.begin(), g.end(), [&](std::uint32_t i) { return contains(chosen, i); })) continue;
    if (open == nullptr || g.size() < open->size()) open = &g;
  }
  if (open == nullptr) return true;
  if (chosen.size() == most) return false;
  for (const std::uint32_t i : *open) {
    chosen.push_back(i);
    if (extend(groups, most, chosen)) return true;
    chosen.pop_back();
  }
  return false;
}

}  // namespace

Group minimum_hitting_set(const std::vector<Group>& groups) {
  // Groups that share no body need one each.
  std::size_t least = 0;
  Group seen;
  for (const Group& g : groups)
    if (std::none_of(g.begin(), g.end(), [&](std::uint32_t i) { return contains(seen, i); })) {
      ++least;
      seen.insert(seen.end(), g.begin(), g.end());
    }
  for (std::size_t most = least;; ++most) {
    Group chosen;
    if (!extend(groups, most, chosen)) continue;
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }
}

std::vector<Group> moving_groups(const Pile& pile, const Motions& motion) {
  if (motion.empty()) return {};  // how it moves is not known
  std::vector<double> size(motion.size());
  double most = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    size[i] = motion[i].v.norm() + motion[i].w.norm() * pile.bodies[i].radius;
    most = std::max(most, size[i]);
  }
  const auto moves = [&](std::uint32_t i) { return !pile.bodies[i].fixed && size[i] > 1e-5 * most; };
  DisjointSets sets(motion.size());
  for (const Contact& c : pile.contacts)
    if (moves(c.a) && moves(c.b)) sets.join(c.a, c.b);
  std::map<std::uint32_t, Group> groups;
  for (std::uint32_t i = 0; i < motion.size(); ++i)
    if (moves(i)) groups[sets.root(i)].push_back(i);
  std::vector<Group> result;
  for (auto& [root, group] : groups) result.push_back(std::move(group));
  return result;
}

namespace {

Holds find_holds(const Pile& pile, Judge judged, const Stop& stop) {
  Holds result;
  bool exact = true;  // each group falls, which is a proof
  const auto add = [&](Group group) {
    result.groups.push_back(smallest(pile, std::move(group), judged, stop));
    // Of hitting sets of the same size, one of large bodies: these are easy to reach and to grip.
    std::stable_sort(result.groups.back().begin(), result.groups.back().end(),
                     [&](std::uint32_t a, std::uint32_t b) { return pile.bodies[a].radius > pile.bodies[b].radius; });
    exact = exact && verdict_alone(pile, result.groups.back(), judged, stop) == Verdict::falls;
  };
  // Bodies that nothing holds: found at once, and most groups are of this kind.
  for (std::uint32_t i = 0; i < pile.bodies.size() && !(stop && stop()); ++i)
    if (!pile.bodies[i].fixed)
      if (const Verdict verdict = verdict_alone(pile, {i}, judge, stop); verdict != Verdict::stands) {
        result.groups.push_back({i});
        exact = exact && verdict == Verdict::falls;
      }
  for (int round = 0; round < kRounds && !(stop && stop()); ++round) {
    result.held = minimum_hitting_set(result.groups);
    const Judgement found = judged(held(pile, result.held), stop);
    if (found.verdict == Verdict::stands) {
      result.found = true;
      result.proved = exact;
      return result;
    }
    bool more = false;
    for (Group& g : moving_groups(held(pile, result.held), found.motion))
      if (must_be_hit(pile, g, judged, stop)) {
        add(std::move(g));
        more = true;
      }
    if (more) continue;
    // No part of it is a reason by itself: everything that is free.
    Group free;
    for (std::uint32_t i = 0; i < pile.bodies.size(); ++i)
      if (!pile.bodies[i].fixed && !contains(result.held, i)) free.push_back(i);
    if (free.empty()) return result;
    add(std::move(free));
  }
  return result;
}

}  // namespace

Holds least_holds(const Pile& pile, const Stop& stop) { return find_holds(pile, judge, stop); }

Holds least_holds_by_forces(const Pile& pile, const Stop& stop) { return find_holds(pile, judge_forces, stop); }

}  // namespace dismantle::statics
