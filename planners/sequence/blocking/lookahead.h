/// Tells idle threads what will probably be asked next. No result depends on it.
#pragma once

#include <vector>

#include "blocking/immobility.h"
#include "blocking/search_history.h"

namespace dismantle::blocking {

class Lookahead {
 public:
  /// `immobility` and `straight`: null when switched off; the former needs the latter. All must outlive this.
  Lookahead(const DisassemblyState& state, const SearchHistory& history, PathOracle& oracle, Immobility* immobility,
            const StraightMotion* straight);

  /// `now` is asked next. `next`: those whose searches follow in the same round, if it finds nothing.
  void before_search(const GroupState& group, const Attempt& now, const Subassemblies& next) const;
  /// `now` was successful: attempts that were hinted for the other case are of no more use.
  void after_success(const GroupState& group, const Attempt& now) const;
  /// `now`, and then probably the first of `next`.
  void before_attempts(const Attempt& now, std::vector<Attempt> next) const;
  /// Proofs that will be asked for if no partial translation is found.
  void before_translations(const GroupState& group) const;
  /// Proofs that will probably be asked for after this one.
  std::vector<ImmobilityQuestion> before_proof(const GroupState& group, const ImmobilityQuestion& question) const;
  bool other_pairs_wait() const;

 private:
  using Attempts = std::vector<Attempt>;
  bool is_likely_to_leave(const GroupState& group, const Attempt& now) const;
  Attempts after_failure_of(const GroupState& group, const Attempt& now, const Subassemblies& next) const;
  Attempts after_success_of(const GroupState& group, const Attempt& now) const;
  Attempts next_searches(const GroupState& group) const;
  void add_round(const GroupState& group, Attempts& attempts) const;
  void add_next_round(const GroupState& group, Attempts& attempts) const;
  void add_waiting(const GroupState& group, unsigned depth, const Subassemblies& ids, Attempts& attempts) const;
  void add_searches(const GroupState& group, unsigned depth, const Subassemblies& ids, Attempts& attempts) const;
  void add_other_groups(Attempts& attempts) const;
  std::vector<ImmobilityQuestion> likely_proofs(const GroupState& now) const;
  bool is_active() const;
  std::size_t most() const;

  const DisassemblyState& state_;
  const SearchHistory& history_;
  PathOracle& oracle_;
  Immobility* immobility_;
  const StraightMotion* straight_;
};

}  // namespace dismantle::blocking
