#include "dismantle/orders/replay.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "dismantle/part_set.h"
#include "own_axes.h"
#include "reference_groups.h"
#include "straight_cuts.h"

namespace dismantle {
namespace {

std::vector<PlacedPart> as_assembled(const std::vector<PartId>& parts) {
  std::vector<PlacedPart> placed;
  for (const PartId id : parts) placed.push_back({id, Pose{}});
  return placed;
}

class Replay {
 public:
  Replay(const Assembly& assembly, const std::vector<ReferenceStep>& order, const Verifier& verifier,
         const RunContext& context, const std::function<void(const ReplayedItem&)>& seen)
      : assembly_(assembly),
        order_(order),
        verifier_(verifier),
        context_(context),
        groups_(order),
        seen_(seen),
        cuts_(assembly, verifier) {
    Aabb all;
    for (const Part& part : assembly.parts) all.extend(part.mesh->box());
    far_ = all.empty() ? 1 : 1.1 * all.size().norm();
  }

  std::vector<ReplayedItem> run() {
    std::vector<PartId> all;
    for (const Part& part : assembly_.parts) all.push_back(part.id);
    take_apart("", std::move(all));
    return std::move(out_);
  }

 private:
  void take_apart(const std::string& group, std::vector<PartId> left) {
    around_.insert(group);
    std::vector<std::string> inner;
    for (auto step = order_.rbegin(); step != order_.rend(); ++step) {
      if (step->group != group) continue;
      StepItems<PartId> found = groups_.items_of(*step, around_);
      std::vector<ReplayedItem> items;
      for (const PartId part : found.parts) items.push_back({step->step, group, {}, {part}});
      for (const std::string& name : found.groups) {
        const auto& parts = groups_.parts_of(name);
        items.push_back({step->step, group, name, {parts.begin(), parts.end()}});
        inner.push_back(name);
      }
      take_out(std::move(items), left);
    }
    for (const std::string& name : inner) {
      const auto& parts = groups_.parts_of(name);
      take_apart(name, {parts.begin(), parts.end()});
    }
    around_.erase(group);
  }

  /// Whatever order of the items is possible. When no item can leave, the one that cuts in least is refused and taken
  /// away, and the others are tried again.
  void take_out(std::vector<ReplayedItem> items, std::vector<PartId>& left) {
    while (!items.empty() && !context_.should_stop()) {
      auto next = std::find_if(items.begin(), items.end(), [&](ReplayedItem& item) {
        const std::vector<PartId> rest = without(left, item.parts);
        return rest.empty() || leaves(item, rest);
      });
      if (context_.should_stop()) return;
      if (next == items.end()) next = least_of(items, left);
      if (next == items.end()) return;  // stopped
      left = without(left, next->parts);
      if (!left.empty()) {  // else it is what the others are put to
        context_.progress("replay", out_.size() + 1, assembly_.parts.size(), assembly_.parts[next->parts.front()].name);
        if (seen_) seen_(*next);
        out_.push_back(std::move(*next));
      }
      items.erase(next);
    }
  }

  Path straight(const ReplayedItem& item, const Eigen::Vector3d& along) const {
    return {std::vector<Pose>(item.parts.size()), std::vector<Pose>(item.parts.size(), Pose{far_ * along, Pose{}.q})};
  }

  /// Along the own axes, both ways.
  std::vector<Eigen::Vector3d> directions(const ReplayedItem& item) const {
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector3d& axis : own_axes(item.parts, assembly_)) {
      out.push_back(axis);
      out.push_back(-axis);
    }
    return out;
  }

  static bool has(const std::vector<PartId>& sorted, PartId part) {
    return std::binary_search(sorted.begin(), sorted.end(), part);
  }

  /// The same with the part that leaves as the first.
  static Violation of_moving(Violation violation, const std::vector<PartId>& rest) {
    if (!has(rest, violation.other)) std::swap(violation.part, violation.other);
    return violation;
  }

  /// `rest`: ascending. A pair that the verifier refused is in the way as long as its part is there.
  bool leaves(ReplayedItem& item, const std::vector<PartId>& rest) {
    std::vector<std::optional<Violation>>& refused = refused_[item.parts];
    const std::vector<Eigen::Vector3d> all = directions(item);
    refused.resize(all.size());
    for (std::size_t k = 0; k < all.size() && !context_.should_stop(); ++k) {
      if (refused[k] && has(rest, refused[k]->other)) continue;
      const MotionCheck check =
          verifier_.check_motion(item.parts, as_assembled(rest), straight(item, all[k]), context_);
      if (check.valid) {
        item.direction = -all[k];
        item.possible = true;
        return true;
      }
      if (check.violation && !check.interrupted) refused[k] = of_moving(*check.violation, rest);
    }
    return false;
  }

  using Items = std::vector<ReplayedItem>;

  struct Stuck {
    Items::iterator item;
    std::vector<PartId> rest;  // out of which it cannot be pulled
  };

  bool would_leave(ReplayedItem item, const std::vector<PartId>& rest) { return leaves(item, rest); }

  /// Of items that all cannot leave, those that are not only waiting for others: they cannot leave when the others are
  /// gone. If they lock each other: those without which another one leaves; else all.
  std::vector<Stuck> stuck(Items& items, const std::vector<PartId>& left) {
    std::vector<PartId> others_gone = left;
    for (const ReplayedItem& item : items) others_gone = without(others_gone, item.parts);
    std::vector<Stuck> held, locking, all;
    for (auto item = items.begin(); item != items.end(); ++item)
      if (!would_leave(*item, others_gone)) held.push_back({item, others_gone});
    if (!held.empty()) return held;
    for (auto item = items.begin(); item != items.end(); ++item) {
      const std::vector<PartId> rest = without(left, item->parts);
      all.push_back({item, rest});
      if (std::any_of(items.begin(), items.end(), [&](const ReplayedItem& other) {
            return &other != &*item && would_leave(other, without(rest, other.parts));
          }))
        locking.push_back({item, rest});
    }
    return locking.empty() ? all : locking;
  }

  struct Motion {
    const Stuck* of = nullptr;
    Eigen::Vector3d out;
    double at_least = 0;
  };

  /// The item that cuts in least, explained; the end: told to stop. What rays find shallow is measured first.
  Items::iterator least_of(Items& items, const std::vector<PartId>& left) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    const std::vector<Stuck> candidates = stuck(items, left);
    std::vector<Motion> motions;
    for (const Stuck& s : candidates)
      for (const Eigen::Vector3d& out : directions(*s.item)) {
        const auto seen = cuts_.by_rays(s.item->parts, s.rest, out, kAny, context_);
        motions.push_back({&s, out, seen ? seen->excess() : 0});
      }
    std::stable_sort(motions.begin(), motions.end(),
                     [](const Motion& a, const Motion& b) { return a.at_least < b.at_least; });
    const Motion* best = nullptr;
    double least = kAny;
    for (const Motion& m : motions) {
      if (m.at_least >= least) break;
      const auto cut = cuts_.deepest(m.of->item->parts, m.of->rest, m.out, least, context_);
      if (context_.should_stop()) return items.end();
      const double excess = cut ? cut->excess() : 0;
      if (!(excess < least)) continue;
      least = excess;
      best = &m;
    }
    explain(*best->of->item, best->out, best->of->rest);
    return context_.should_stop() ? items.end() : best->of->item;
  }

  void explain(ReplayedItem& item, const Eigen::Vector3d& out, const std::vector<PartId>& rest) {
    item.direction = -out;
    const std::vector<Eigen::Vector3d> all = directions(item);
    const auto index = static_cast<std::size_t>(std::find(all.begin(), all.end(), out) - all.begin());
    if (const std::optional<Violation>& refused = refused_[item.parts][index]) {  // may be a proof that failed
      item.part = refused->part;
      item.other = refused->other;
      item.at = refused->point;
    }
    if (const auto cut = cuts_.exactly(item.parts, rest, out, context_);
        cut && cut->excess() > verifier_.options().max_penetration) {
      item.part = cut->part;
      item.other = cut->other;
      item.depth = cut->excess();
      item.at = cut->point;
      item.measured = cut->proved;
    }
  }

  const Assembly& assembly_;
  const std::vector<ReferenceStep>& order_;
  const Verifier& verifier_;
  const RunContext& context_;
  const ReferenceGroups<ReferenceStep> groups_;
  const std::function<void(const ReplayedItem&)>& seen_;
  StraightCuts cuts_;
  double far_ = 1;  // after so far, everything is apart
  std::set<std::string> around_;
  std::map<std::vector<PartId>, std::vector<std::optional<Violation>>> refused_;  // by item and direction
  std::vector<ReplayedItem> out_;
};

}  // namespace

std::vector<ReplayedItem> replay(const Assembly& assembly, const std::vector<ReferenceStep>& order,
                                 const Verifier& verifier, const RunContext& context,
                                 const std::function<void(const ReplayedItem&)>& seen) {
  return Replay(assembly, order, verifier, context, seen).run();
}

}  // namespace dismantle
