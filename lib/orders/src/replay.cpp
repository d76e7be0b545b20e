#include "dismantle/orders/replay.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "dismantle/part_set.h"
#include "dismantle/verification/motion_depth.h"
#include "own_axes.h"
#include "reference_groups.h"

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
         const RunContext& context)
      : assembly_(assembly),
        order_(order),
        verifier_(verifier),
        context_(context),
        groups_(order),
        meter_(assembly, verifier) {
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
      const auto leaving = std::find_if(items.begin(), items.end(), [&](ReplayedItem& item) {
        const std::vector<PartId> rest = without(left, item.parts);
        return rest.empty() || leaves(item, rest);
      });
      if (leaving != items.end()) {
        done(std::move(*leaving), left);
        items.erase(leaving);
        continue;
      }
      for (ReplayedItem& item : items) explain(item, without(left, item.parts));
      const auto least =
          std::min_element(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
      left = without(left, least->parts);
      out_.push_back(std::move(*least));
      items.erase(least);
    }
  }

  void done(ReplayedItem item, std::vector<PartId>& left) {
    left = without(left, item.parts);
    if (left.empty()) return;  // what the others are put to
    item.possible = true;
    context_.progress("replay", out_.size() + 1, assembly_.parts.size(), assembly_.parts[item.parts.front()].name);
    out_.push_back(std::move(item));
  }

  Path straight(const ReplayedItem& item, const Eigen::Vector3d& along) const {
    return {std::vector<Pose>(item.parts.size()), std::vector<Pose>(item.parts.size(), Pose{far_ * along, Pose{}.q})};
  }

  /// What is known of a straight motion out of what was there at some time. What is there later is part of it, so a
  /// part that is still there is in the way as it was.
  struct Straight {
    std::optional<PartId> blocker{};   ///< a part that the verifier refused
    std::optional<MotionDepth> cut{};  ///< the deepest pair
    bool whole = false;                ///< `cut` is not only a lower bound
  };

  /// The motions along the own axes, both ways. `visit(direction, known)` returns whether to go on.
  template <class Visit>
  void for_directions(const ReplayedItem& item, Visit visit) {
    std::size_t index = 0;
    for (const Eigen::Vector3d& axis : own_axes(item.parts, assembly_))
      for (const double sign : {1.0, -1.0})
        if (!visit(Eigen::Vector3d(sign * axis), known_[{item.parts, index++}])) return;
  }

  static bool has(const std::vector<PartId>& sorted, PartId part) {
    return std::binary_search(sorted.begin(), sorted.end(), part);
  }

  /// `rest`: ascending.
  bool leaves(ReplayedItem& item, const std::vector<PartId>& rest) {
    bool found = false;
    for_directions(item, [&](const Eigen::Vector3d& out, Straight& known) {
      if (known.blocker && has(rest, *known.blocker)) return true;
      const MotionCheck check = verifier_.check_motion(item.parts, as_assembled(rest), straight(item, out), context_);
      if (check.valid) {
        item.direction = -out;
        found = true;
      } else if (check.violation && !check.interrupted) {
        known.blocker = has(rest, check.violation->other) ? check.violation->other : check.violation->part;
      }
      return !found && !context_.should_stop();
    });
    return found;
  }

  /// Where it cuts in least.
  void explain(ReplayedItem& item, const std::vector<PartId>& rest) {
    double least = std::numeric_limits<double>::infinity();
    for_directions(item, [&](const Eigen::Vector3d& out, Straight& known) {
      const bool holds = known.cut && has(rest, known.cut->other);
      if (holds && known.cut->excess() >= least) return true;
      if (!holds || !known.whole) {
        MotionDepthOptions options;
        options.stop_above = least;
        known.cut = meter_.deepest(item.parts, as_assembled(rest), straight(item, out), options, context_);
        if (context_.should_stop()) return false;
        known.whole = known.cut && known.cut->excess() <= least;
      }
      if (!known.cut || !(known.cut->excess() < least)) return true;
      least = known.cut->excess();
      item.direction = -out;
      item.part = known.cut->part;
      item.other = known.cut->other;
      item.depth = known.cut->excess();
      item.at = known.cut->point;
      return true;
    });
  }

  const Assembly& assembly_;
  const std::vector<ReferenceStep>& order_;
  const Verifier& verifier_;
  const RunContext& context_;
  const ReferenceGroups<ReferenceStep> groups_;
  MotionDepthMeter meter_;
  double far_ = 1;  // after so far, everything is apart
  std::set<std::string> around_;
  std::map<std::pair<std::vector<PartId>, std::size_t>, Straight> known_;  // by parts and number of the direction
  std::vector<ReplayedItem> out_;
};

}  // namespace

std::vector<ReplayedItem> replay(const Assembly& assembly, const std::vector<ReferenceStep>& order,
                                 const Verifier& verifier, const RunContext& context) {
  return Replay(assembly, order, verifier, context).run();
}

}  // namespace dismantle
