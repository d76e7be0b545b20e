/// Proofs that parts cannot be separated: which are worth seeking, and when. Proved parts are merged.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "blocking/params.h"
#include "blocking/proofs_ahead.h"
#include "blocking/search_history.h"
#include "blocking_graph/straight_motion.h"

namespace dismantle::blocking {

/// Each question is asked once in a run, and each kind a limited number of times.
class Immobility {
 public:
  using Questions = std::vector<ImmobilityQuestion>;

  /// All references must outlive this.
  Immobility(DisassemblyState& state, StraightMotion& straight, const SearchHistory& history, PathOracle& oracle,
             const ImmobilityParams& params);

  /// What an attempt proved of two of the group as assembled, if it did: they are merged.
  bool merge_proved(GroupState& group, const AttemptResult& answer);
  /// Quick proofs about all pairs of which one was searched without success for as much as such proofs cost, or of all
  /// when the searches are over.
  bool merge_caged(GroupState& group);
  /// Proofs about a flat piece of `id` and the larger parts that its last search touched, once its searches have cost
  /// as much as such proofs; without `id`: of all, at any cost.
  bool merge_flat(GroupState& group, SubassemblyId id);
  bool merge_flat(GroupState& group);
  /// Confinement, for motions that penetrate as deep as paths may: for those that were searched to `proof_depth` and
  /// have only one other in their way.
  bool merge_confined_early(GroupState& group);
  /// Confinement, for motions that penetrate half as deep. It settles more, and does not rule out all paths, so it
  /// comes after all searches.
  bool merge_confined_late(GroupState& group);
  /// All of a group in which no part can slide for good, also for motions that penetrate half as deep.
  bool merge_interlocked(GroupState& group);
  /// True if the next search reaches the depth that triggers merge_confined_early().
  bool is_close_to_proof(const GroupState& group) const;

  // What will probably be asked, for idle threads.
  Questions cage_questions(const GroupState& group) const;
  Questions flat_questions(const GroupState& group) const;
  void add_questions(ImmobilityQuestion::Kind kind, SubassemblyId a, SubassemblyId b, Questions& questions) const;
  /// The only one that the last search for `id` touched; of two, the other.
  std::optional<SubassemblyId> only_blocker(const GroupState& group, SubassemblyId id) const;
  bool was_asked(const ImmobilityQuestion& question) const { return asked_.contains(question); }
  /// Idle threads seek these, the first first; what is not among them any more is cancelled.
  void begin(std::span<const ImmobilityQuestion> questions);
  /// Called before a proof is sought; returns what will probably be asked after it.
  std::function<Questions(const GroupState&, const ImmobilityQuestion&)> before_proof;

 private:
  bool merge_first(GroupState& group, const Questions& questions);
  void add_flat_questions(const GroupState& group, SubassemblyId id, Questions& questions) const;
  bool limit_reached(ImmobilityQuestion::Kind kind) const;

  DisassemblyState& state_;
  StraightMotion& straight_;
  const SearchHistory& history_;
  PathOracle& oracle_;
  const ImmobilityParams& params_;
  std::set<ImmobilityQuestion> asked_;  // or not worth asking
  std::map<ImmobilityQuestion::Kind, unsigned> proofs_;
  std::set<std::vector<PartId>> interlocked_;  // groups that were asked about
  ProofsAhead answers_;
};

}  // namespace dismantle::blocking
