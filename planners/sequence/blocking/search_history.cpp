#include "blocking/search_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dismantle::blocking {

const PastSearch* SearchHistory::last(SubassemblyId id) const {
  const auto known = last_.find(state_.part_of(id));
  return known == last_.end() ? nullptr : &known->second;
}

void SearchHistory::add(SubassemblyId id, PastSearch search, const PathResult& result) {
  const PartId part = state_.part_of(id);
  last_[part] = std::move(search);
  cost_[part] = cost_of(part, result);
  work_ += work_of({part}, result);
}

Attempt SearchHistory::attempt_for(const GroupState& group, SubassemblyId id, unsigned depth) const {
  Attempt attempt = state_.attempt_for(group, {id});
  attempt.max_depth = depth;
  attempt.resume = true;
  return attempt;
}

bool SearchHistory::reached_depth_limit(SubassemblyId id) const {
  const PastSearch* search = last(id);
  return search != nullptr && search->outcome == Outcome::depth_limit;
}

bool SearchHistory::is_worthwhile(const GroupState& group, SubassemblyId id, unsigned depth) const {
  const PastSearch* search = last(id);
  if (search == nullptr) return true;
  const auto& touched = search->blocked_by;
  const std::size_t count =
      search->depth > 1 ? std::min<std::size_t>(touched.size(), params_.touched_parts) : touched.size();
  const bool room = std::any_of(touched.begin(), touched.begin() + static_cast<std::ptrdiff_t>(count),
                                [&](PartId part) { return !group.contains(state_.subassembly_of(part)); });
  return room || (reached_depth_limit(id) && search->depth < depth);
}

unsigned SearchHistory::max_depth(const GroupState& group) const {
  if (group.proof != nullptr) return std::min(params_.depth_of_rotations, params_.max_depth);
  return group.translations_exhausted ? std::min(params_.depth_without_translations, params_.max_depth)
                                      : params_.max_depth;
}

unsigned SearchHistory::next_depth_of_pair(const GroupState& group, bool others_wait) const {
  return others_wait && group.pair_depth < params_.pair_depth ? 2 * group.pair_depth : 0;
}

/// Simulated steps and state checks take longer for parts with more triangles. Counts are used instead of seconds
/// because they are the same on every machine.
int SearchHistory::cost_of(PartId part, const PathResult& result) const {
  return static_cast<int>(std::log2(std::max(1.0, work_of({part}, result))) / params_.cost_octaves);
}

double SearchHistory::work_of(const std::vector<PartId>& moving, const PathResult& result) const {
  double triangles = 0;
  for (const PartId part : moving)
    triangles += static_cast<double>(state_.assembly().parts[part].mesh->triangles.size());
  return (1 + result.stats.cost) * triangles;
}

void SearchHistory::sort_by_cost(const GroupState& group, Subassemblies& ids, unsigned depth) const {
  const SubassemblyId housing = state_.housing_of(group);
  const auto cost = [&](SubassemblyId s) {
    const auto known = cost_.find(state_.part_of(s));
    return known == cost_.end() ? 0 : known->second;
  };
  const auto again = [&](SubassemblyId s) {
    const PastSearch* search = last(s);
    return search != nullptr && search->depth >= depth;
  };
  std::stable_sort(ids.begin(), ids.end(), [&](SubassemblyId a, SubassemblyId b) {
    if ((a == housing) != (b == housing)) return b == housing;
    return again(a) != again(b) ? again(b) : cost(a) < cost(b);
  });
}

Subassemblies SearchHistory::waiting_of(const Subassemblies& ids) const {
  Subassemblies waiting;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(waiting),
               [&](SubassemblyId s) { return reached_depth_limit(s); });
  return waiting;
}

/// Results for a group are not valid any more when parts that stay in it have moved.
void SearchHistory::on_group_changed(GroupState& group, const GroupChange& change) {
  if (!change.moves_remaining()) return;
  for (const SubassemblyId s : group.members)
    for (const PartId id : state_.parts_of(s)) last_.erase(id);
}

}  // namespace dismantle::blocking
