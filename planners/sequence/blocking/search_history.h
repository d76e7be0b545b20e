/// Results of the path searches for single parts, and which searches are worthwhile next.
#pragma once

#include <map>
#include <vector>

#include "blocking/parameters.h"
#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// An unsuccessful search.
struct PastSearch {
  unsigned depth = 0;
  Outcome outcome = Outcome::exhausted;
  std::vector<PartId> blocked_by;  ///< parts that were touched, most often first
  std::size_t group_size = 0;      ///< when it was made
};

class SearchHistory final : public GroupListener {
 public:
  /// Both must outlive this.
  SearchHistory(const DisassemblyState& state, const PathSearchParameters& params) : state_(state), params_(params) {}

  /// The last unsuccessful search for `id`. Null: none since a part that stays in the group was moved.
  const PastSearch* last(SubassemblyId id) const;
  void add(SubassemblyId id, PastSearch search, const PathResult& result);
  /// Work of all unsuccessful searches for single parts so far; work_of(): of one search for `moving`. In the unit of
  /// sort_by_cost(), which does not depend on the machine.
  double work() const { return work_; }
  double work_of(const std::vector<PartId>& moving, const PathResult& result) const;

  /// The attempt that searches for a path of `id` out of its group. The oracle resumes the last search if it can.
  Attempt attempt_for(const GroupState& group, SubassemblyId id, unsigned depth) const;
  /// Did its last search end because of the depth limit?
  bool reached_depth_limit(SubassemblyId id) const;
  /// A failed search is not repeated to the same depth while all parts that it touched (from depth 2 on: touched most)
  /// are in the group, because it would probably fail again. It may still succeed, since the hulls of all parts that
  /// stay matter too. So PostponedSearch makes these searches before a group is given up.
  bool is_worthwhile(const GroupState& group, SubassemblyId id, unsigned depth) const;
  /// Largest depth worth searching. Deep searches are for paths of many translations, so the depth is smaller after the
  /// search for partial translations has visited all arrangements.
  unsigned max_depth(const GroupState& group) const;
  /// Twice the depth of the pair's last search. 0 (no limit): no other pair waits, or that depth is `pair_depth`.
  unsigned next_depth_of_pair(const GroupState& group, bool others_wait) const;
  /// Sorts by the cost of the last search, because a cheap search is usually cheap one level deeper, and a part that
  /// leaves frees others. Parts searched to this depth before come later: more of their blockers may have left by then.
  /// The housing always comes last. It touches most parts, so a cheap search means that it is held, not that the next
  /// search is cheap.
  void sort_by_cost(const GroupState& group, Subassemblies& ids, unsigned depth) const;
  /// The value of GroupState::waiting: members of `ids` whose last search reached its depth limit.
  Subassemblies waiting_of(const Subassemblies& ids) const;

  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  int cost_of(PartId part, const PathResult& result) const;

  const DisassemblyState& state_;
  const PathSearchParameters& params_;
  std::map<PartId, PastSearch> last_;
  double work_ = 0;
  std::map<PartId, int> cost_;  ///< of the last search for the part, logarithmic
};

}  // namespace dismantle::blocking
