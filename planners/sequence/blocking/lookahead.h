/// Tells idle threads what will probably be asked next. No result depends on it.
#pragma once

#include <vector>

#include "blocking/search_history.h"

namespace dismantle::blocking {

class Lookahead {
 public:
  /// All must outlive this.
  Lookahead(const DisassemblyState& state, const SearchHistory& history, PathOracle& oracle);

  /// `now` is asked next. `next`: those whose searches follow in the same round, if it finds nothing.
  void before_search(const GroupState& group, const Attempt& now, const Subassemblies& next) const;
  /// `now` was successful: attempts that were hinted for the other case are of no more use.
  void after_success(const GroupState& group, const Attempt& now) const;
  /// `now`, and then probably the first of `next`.
  void before_attempts(const Attempt& now, std::vector<Attempt> next) const;
  bool other_pairs_wait() const;

 private:
  using Attempts = std::vector<Attempt>;
  bool is_likely_to_leave(const GroupState& group, const Attempt& now) const;
  Attempts after_failure_of(const GroupState& group, const Attempt& now, const Subassemblies& next) const;
  Attempts after_success_of(const GroupState& group, const Attempt& now) const;
  void add_round(const GroupState& group, Attempts& attempts) const;
  void add_next_round(const GroupState& group, Attempts& attempts) const;
  void add_waiting(const GroupState& group, unsigned depth, const Subassemblies& ids, Attempts& attempts) const;
  void add_searches(const GroupState& group, unsigned depth, const Subassemblies& ids, Attempts& attempts) const;
  void add_other_groups(Attempts& attempts) const;
  bool is_active() const;
  std::size_t most() const;

  const DisassemblyState& state_;
  const SearchHistory& history_;
  PathOracle& oracle_;
};

}  // namespace dismantle::blocking
