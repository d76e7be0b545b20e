/// Hints for idle threads: the attempts that will probably be asked for next. No result depends on these hints.
#pragma once

#include <vector>

#include "blocking/search_history.h"

namespace dismantle::blocking {

class Lookahead {
 public:
  /// All must outlive this.
  Lookahead(const DisassemblyState& state, const SearchHistory& history, PathOracle& oracle);

  /// Call before `now` is asked. `next`: the searches that follow in the same round if `now` finds no path.
  void before_search(const GroupState& group, const Attempt& now, const Subassemblies& next) const;
  /// Call after `now` has succeeded: replaces the hints for its failure.
  void after_success(const GroupState& group, const Attempt& now) const;
  /// Hints that `now` is asked next, and then probably `next` in order.
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
