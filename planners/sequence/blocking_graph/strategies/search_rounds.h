/// Rounds of searches by the path planner for single parts, one action deeper whenever no part left (Tian et al. 2022,
/// Algorithm 2). `blocking` has a strategy of its own that orders searches by cost.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <utility>

#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class SearchRounds final : public Strategy {
 public:
  struct Settings {
    unsigned max_depth = 0;  ///< 0 = no limit
    bool resume = false;     ///< each search resumes the last one of the same part (Attempt::resume)
  };
  /// Sorts the subassemblies of the group that may leave into the order of the searches.
  using Order = std::function<Subassemblies(const GroupState& group, const Subassemblies& ids)>;

  /// `order`: if empty, searches follow the order of the group. All references must outlive this.
  SearchRounds(DisassemblyState& state, PathOracle& oracle, const Settings& settings, Order order = {})
      : state_(state), oracle_(oracle), settings_(settings), order_(std::move(order)) {}
  std::string_view name() const noexcept override { return "search_rounds"; }
  Cost cost() const noexcept override { return Cost::limited_search; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  /// Progress in one group.
  struct Round {
    unsigned depth = 1;
    std::map<PartId, Outcome> last;  ///< of the last search for each part, since the last change of the group
  };
  Attempt question(const GroupState& group, SubassemblyId id, unsigned depth) const;
  bool search(GroupState& group, SubassemblyId id, unsigned depth, std::span<const SubassemblyId> next);

  DisassemblyState& state_;
  PathOracle& oracle_;
  Settings settings_;
  Order order_;
  PerGroup<Round> rounds_;
};

}  // namespace dismantle::blocking
