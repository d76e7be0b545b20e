#include "dismantle/statics/holds.h"

#include <algorithm>
#include <map>
#include <utility>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/statics/certificates.h"

namespace dismantle::statics {
namespace {

using Group = std::vector<std::uint32_t>;
using Stop = std::function<bool()>;

constexpr int kRounds = 400;

bool contains(const Group& group, std::uint32_t body) {
  return std::find(group.begin(), group.end(), body) != group.end();
}

Pile held(Pile pile, const Group& bodies) {
  for (const std::uint32_t i : bodies) pile.bodies[i].fixed = true;
  return pile;
}

Motions restricted(const Motions& motion, const Group& group) {
  Motions part(motion.size());
  for (const std::uint32_t i : group) part[i] = motion[i];
  return part;
}

/// Everything that a judgement depends on.
std::vector<double> key_of(const Pile& pile, bool by_forces) {
  std::vector<double> key{static_cast<double>(by_forces), static_cast<double>(pile.bodies.size()),
                          static_cast<double>(pile.contacts.size())};
  const auto add = [&](const Eigen::Vector3d& v) { key.insert(key.end(), v.data(), v.data() + 3); };
  add(pile.down);
  for (const Body& b : pile.bodies) {
    key.insert(key.end(), {b.weight, b.radius, static_cast<double>(b.fixed)});
    add(b.center);
  }
  for (const Contact& c : pile.contacts) {
    key.insert(key.end(), {static_cast<double>(c.a), static_cast<double>(c.b), c.friction,
                           static_cast<double>(c.bonded), static_cast<double>(c.points.size())});
    add(c.normal);
    for (const Eigen::Vector3d& p : c.points) add(p);
  }
  for (const Push& p : pile.pushes) {
    key.push_back(p.body);
    add(p.at);
    add(p.force);
  }
  return key;
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

std::vector<Group> hanging_groups(const Pile& pile) {
  constexpr double kVertical = 0.05;  // sine of the angle of a contact to the vertical
  const std::size_t count = pile.bodies.size();
  std::vector<bool> carried(count);
  for (std::size_t i = 0; i < count; ++i) carried[i] = pile.bodies[i].fixed;
  for (bool more = true; more;) {
    more = false;
    for (const Contact& c : pile.contacts) {
      const double up = -c.normal.dot(pile.down);  // on a
      if (!carried[c.a] && carried[c.b] && (c.bonded || up > kVertical)) carried[c.a] = more = true;
      if (!carried[c.b] && carried[c.a] && (c.bonded || up < -kVertical)) carried[c.b] = more = true;
    }
  }
  DisjointSets sets(count);
  for (const Contact& c : pile.contacts)
    if (!carried[c.a] && !carried[c.b]) sets.join(c.a, c.b);
  std::map<std::uint32_t, Group> groups;
  for (std::uint32_t i = 0; i < count; ++i)
    if (!carried[i]) groups[sets.root(i)].push_back(i);
  std::vector<Group> result;
  for (auto& [root, group] : groups)
    if (group.size() > 1) result.push_back(std::move(group));
  return result;
}

namespace {

class Search {
 public:
  Search(const Pile& pile, bool by_forces, const Stop& stop, KnownJudgements* known)
      : pile_(pile), by_forces_(by_forces), stop_(stop), known_(known) {}

  Holds run() {
    // Bodies that nothing holds: found at once, and most groups are of this kind.
    for (std::uint32_t i = 0; i < pile_.bodies.size() && !stopped(); ++i)
      if (!pile_.bodies[i].fixed)
        if (Judgement found = alone({i}, false); found.verdict != Verdict::stands)
          result_.groups.push_back({{i}, std::move(found.motion)});
    if (by_forces_) add_wedged();
    for (int round = 0; round < kRounds && !stopped(); ++round) {
      std::vector<Group> groups;
      for (const HoldGroup& g : result_.groups) groups.push_back(g.bodies);
      result_.held = minimum_hitting_set(groups);
      const Pile rest = held(pile_, result_.held);
      Judgement found = by_forces_ ? judge_forces(rest, stop_) : judge(rest, stop_);
      if (found.verdict == Verdict::stands) {
        result_.found = true;
        result_.forces = std::move(found.forces);
        result_.displacement = std::move(found.displacement);
        result_.proved = std::all_of(result_.groups.begin(), result_.groups.end(),
                                     [](const HoldGroup& g) { return !g.motion.empty(); });
        return std::move(result_);
      }
      if (!add_groups(rest, found.motion)) break;
    }
    return std::move(result_);
  }

 private:
  bool stopped() const { return stop_ && stop_(); }

  /// Judges `group` when everything outside of it is held, which is one fixed body then. A motion is that of the whole
  /// pile; only one of falling.
  Judgement alone(const Group& group, bool by_forces) const {
    Pile part;
    part.down = pile_.down;
    constexpr std::uint32_t kHeld = 0;
    part.bodies.push_back({0, Eigen::Vector3d::Zero(), 1, true});
    std::vector<std::uint32_t> number(pile_.bodies.size(), kHeld);
    for (const std::uint32_t i : group) {
      number[i] = static_cast<std::uint32_t>(part.bodies.size());
      part.bodies.push_back(pile_.bodies[i]);
    }
    for (const Contact& c : pile_.contacts)
      if (number[c.a] != kHeld || number[c.b] != kHeld) {
        part.contacts.push_back(c);
        part.contacts.back().a = number[c.a];
        part.contacts.back().b = number[c.b];
      }
    for (Push p : pile_.pushes)
      if (number[p.body] != kHeld) {
        p.body = number[p.body];
        part.pushes.push_back(p);
      }
    Judgement found = known_ != nullptr ? known_->of(part, by_forces, stop_)
                      : by_forces       ? judge_forces(part, stop_)
                                        : judge(part, stop_);
    Motions motion;
    if (found.verdict == Verdict::falls) {
      motion.resize(pile_.bodies.size());
      for (const std::uint32_t i : group) motion[i] = found.motion[number[i]];
    }
    found.motion = std::move(motion);
    return found;
  }

  /// The parts of a motion of falling that are one for themselves; what moves apart from them may be held. Empty: none.
  std::vector<HoldGroup> parts_of(const Motions& motion) const {
    std::vector<HoldGroup> parts;
    for (Group& g : moving_groups(pile_, motion))
      if (Motions own = restricted(motion, g); check_fall(pile_, own).empty())
        parts.push_back({std::move(g), std::move(own)});
    return parts;
  }

  /// Bodies that stand only because somebody pressed them together.
  void add_wedged() {
    for (Group& group : hanging_groups(pile_)) {
      const bool met = std::ranges::any_of(result_.groups, [&](const HoldGroup& g) {
        return std::ranges::all_of(g.bodies, [&](std::uint32_t i) { return contains(group, i); });
      });
      if (met || stopped()) continue;
      if (Judgement found = alone(group, false); found.verdict != Verdict::stands)
        result_.groups.push_back({std::move(group), std::move(found.motion)});
    }
  }

  /// A group of which no body can be left out; halves are tried before single bodies. What falls stays so: only falling
  /// is proved.
  HoldGroup smallest(HoldGroup group) const {
    const bool falls = !group.motion.empty();
    for (std::size_t size = group.bodies.size() / 2; size > 0; size /= 2)
      for (std::size_t first = 0; first < group.bodies.size() && group.bodies.size() > 1;) {
        Group without = group.bodies;
        const auto begin = without.begin() + static_cast<std::ptrdiff_t>(first);
        without.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(size, group.bodies.size() - first)));
        Judgement found;
        found.verdict = Verdict::stands;
        if (!without.empty()) found = alone(without, by_forces_);
        if (found.verdict == Verdict::stands || (falls && found.verdict != Verdict::falls)) {
          first += size;
          continue;
        }
        group = {std::move(without), std::move(found.motion)};
        // What does not take part in the motion is not needed.
        for (HoldGroup& part : parts_of(group.motion))
          if (part.bodies.size() < group.bodies.size()) {
            group = std::move(part);
            size = std::min(size, std::max<std::size_t>(1, group.bodies.size() / 2));
            first = 0;
            break;
          }
      }
    return group;
  }

  void add(HoldGroup group) {
    group = smallest(std::move(group));
    // Of hitting sets of the same size, one of large bodies: these are easy to reach and to grip.
    std::stable_sort(group.bodies.begin(), group.bodies.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return pile_.bodies[a].radius > pile_.bodies[b].radius; });
    result_.groups.push_back(std::move(group));
  }

  /// Groups in a motion of the pile with the present holds. False: nothing can fall.
  bool add_groups(const Pile& rest, const Motions& motion) {
    bool more = false;
    for (Group& g : moving_groups(rest, motion)) {
      HoldGroup group{std::move(g), {}};
      group.motion = restricted(motion, group.bodies);
      if (!check_fall(pile_, group.motion).empty()) {
        Judgement found = alone(group.bodies, by_forces_);
        if (found.verdict == Verdict::stands) continue;
        group.motion = std::move(found.motion);
      }
      add(std::move(group));
      more = true;
    }
    if (more) return true;
    // No part of it is a reason by itself: everything that is free.
    Group free;
    for (std::uint32_t i = 0; i < pile_.bodies.size(); ++i)
      if (!rest.bodies[i].fixed) free.push_back(i);
    if (free.empty()) return false;
    Motions falling = alone(free, by_forces_).motion;
    add({std::move(free), std::move(falling)});
    return true;
  }

  const Pile& pile_;
  bool by_forces_;
  const Stop& stop_;
  KnownJudgements* known_;
  Holds result_;
};

}  // namespace

Judgement KnownJudgements::of(const Pile& pile, bool by_forces, const Stop& stop) {
  std::vector<double> key = key_of(pile, by_forces);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
  }
  Judgement judged = by_forces ? judge_forces(pile, stop) : judge(pile, stop);
  if (stop && stop()) return judged;  // not to be kept
  const std::lock_guard lock(mutex_);
  return known_.emplace(std::move(key), std::move(judged)).first->second;
}

Holds least_holds(const Pile& pile, const Stop& stop, KnownJudgements* known) {
  return Search(pile, false, stop, known).run();
}

Holds least_holds_by_forces(const Pile& pile, const Stop& stop, KnownJudgements* known) {
  return Search(pile, true, stop, known).run();
}

}  // namespace dismantle::statics
