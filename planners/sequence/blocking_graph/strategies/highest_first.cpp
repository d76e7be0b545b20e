#include "blocking_graph/strategies/highest_first.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::blocking {

double HighestFirst::top_of(const Subassemblies& ids) const {
  double top = -std::numeric_limits<double>::infinity();
  for (const PartId id : state_.parts_of(ids)) {
    const Pose& pose = state_.pose(id);
    const Eigen::Vector3d along = pose.q.conjugate() * state_.up();
    const Aabb& box = state_.assembly().parts[id].mesh->box();
    top = std::max(top, pose.t.dot(state_.up()) + along.dot(box.center()) + along.cwiseAbs().dot(0.5 * box.size()));
  }
  return top;
}

Result HighestFirst::apply(GroupState& group) {
  if (state_.preference().active()) return Result::unchanged;  // required checks choose
  Aabb all;
  for (const Part& part : state_.assembly().parts) all.extend(part.mesh->box());
  const double same = 1e-6 * all.size().norm();  // heights that differ by less are equal
  std::vector<Item> items;
  for (Subassemblies& ids : stated_.items(state_, group)) {
    const double top = std::round(top_of(ids) / same);
    items.push_back({std::move(ids), top});
  }
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return a.top > b.top; });
  Subassemblies singles;
  for (const Item& item : items)
    if (item.ids.size() == 1) singles.push_back(item.ids.front());
  std::size_t single = 0;
  for (const Item& item : items) {
    if (state_.stop()) break;
    if (item.ids.size() == 1) ++single;
    if (item.ids.size() > 1 && 2 * item.ids.size() > group.members.size()) continue;  // the others leave it
    if (!state_.may_leave(group, item.ids)) continue;
    if (item.ids.size() > 1 ? group_leaves(group, item.ids)
                            : leaves(group, item.ids, std::span(singles).subspan(single)))
      return Result::restart;
  }
  return Result::unchanged;
}

bool HighestFirst::leaves(GroupState& group, const Subassemblies& ids, std::span<const SubassemblyId> next) {
  while (const auto d = straight_.free_direction(group, ids.front(), next, filter_))
    if (straight_.leave(group, ids, *d)) return true;
  return false;
}

/// The shortest path first.
bool HighestFirst::group_leaves(GroupState& group, const Subassemblies& ids) {
  std::vector<std::pair<double, std::size_t>> candidates;
  for (const std::size_t d : straight_.directions().common)
    if (straight_.admits(filter_, d) && !straight_.was_refused(ids, d)) {
      const auto known = blocker_.find({ids, d});
      if (known == blocker_.end() || !group.contains(known->second))
        candidates.emplace_back(straight_.path_length(group, ids, d), d);
    }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; });
  for (const auto& [length, d] : candidates) {
    const auto blocker = straight_.blocker_of(group, ids, d);
    if (state_.stop()) return false;
    if (blocker)
      blocker_[{ids, d}] = *blocker;
    else if (straight_.leave(group, ids, d))
      return true;
  }
  return false;
}

void HighestFirst::on_group_changed(GroupState&, const GroupChange& change) {
  if (change.moves_remaining()) blocker_.clear();  // they may have moved away
}

}  // namespace dismantle::blocking
