/// What the path searches for single parts have come to, and which are worth making next.
#pragma once

#include <map>
#include <vector>

#include "blocking/params.h"
#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// An unsuccessful search.
struct PastSearch {
  unsigned depth = 0;
  Outcome outcome = Outcome::exhausted;
  std::vector<PartId> blocked_by;  ///< parts that were touched, most often first
  std::size_t group_size = 0;      ///< when it was made
  const AttemptResult* answer = nullptr;
};

class SearchHistory final : public GroupListener {
 public:
  /// Both must outlive this.
  SearchHistory(const DisassemblyState& state, const PathSearchParams& params) : state_(state), params_(params) {}

  /// Null: none since the part was moved.
  const PastSearch* last(SubassemblyId id) const;
  void add(SubassemblyId id, PastSearch search, const PathResult& result);
  /// Work of all unsuccessful searches for single parts until now, and of any result for such parts. The same unit as
  /// sort_by_cost(): does not depend on the machine.
  double work() const { return work_; }
  double work_of(const std::vector<PartId>& moving, const PathResult& result) const;

  /// The search for a path of `id` out of its group. The oracle resumes the last one where it can.
  Attempt attempt_for(const GroupState& group, SubassemblyId id, unsigned depth) const;
  /// Did its last search end because of the depth limit?
  bool reached_depth_limit(SubassemblyId id) const;
  /// A search that failed is not repeated to the same depth while all that it touched are in the group, or, from depth
  /// 2 on, those that it touched most: it would most likely fail again. It may succeed all the same (the hulls of
  /// everything that stays matter too), so PostponedSearch makes all of these once more before a group is given up.
  bool is_worthwhile(const GroupState& group, SubassemblyId id, unsigned depth) const;
  /// Largest depth worth searching. Where the search for partial translations has visited all arrangements, deep
  /// searches, which are for paths of many translations, have nothing to find.
  unsigned max_depth(const GroupState& group) const;
  /// Twice that of the last search of the pair, or 0, no limit: where no other pairs wait, or it is very deep.
  unsigned next_depth_of_pair(const GroupState& group, bool others_wait) const;
  /// Sorts by what the last search cost: what was cheap is mostly cheap to search a little deeper, and a part that
  /// leaves makes room for others. Those that were searched to this depth before come later: more of what was in their
  /// way may be gone by then. The housing comes last at any cost: it touches most parts, so that a search which ended
  /// early says that it is held, not that the next one is cheap.
  void sort_by_cost(const GroupState& group, Subassemblies& ids, unsigned depth) const;
  /// GroupState::waiting: those of `ids` that reached the depth limit.
  Subassemblies waiting_of(const Subassemblies& ids) const;

  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  int cost_of(PartId part, const PathResult& result) const;

  const DisassemblyState& state_;
  const PathSearchParams& params_;
  std::map<PartId, PastSearch> last_;
  double work_ = 0;
  std::map<PartId, int> cost_;  ///< of the last search for the part: about its logarithm
};

}  // namespace dismantle::blocking
