/// The state of a disassembly: the subassemblies and their poses, the groups that are not separated yet, and the
/// removals so far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "blocking_graph/orientations.h"
#include "dismantle/part_set.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"
#include "preference/preference.h"

namespace dismantle::blocking {

/// A subassembly moves as one rigid body: a single part, or parts that a constraint keeps together or that are proved
/// inseparable. Subassemblies are numbered in the order in which they are tried.
using SubassemblyId = std::size_t;
using Subassemblies = std::vector<SubassemblyId>;

/// Subassemblies that have not been separated from each other. A run begins with the groups of its start; each removal
/// splits a group in two. `members`, `id` and `initial` define the group. The rest is progress of searches that more
/// than one strategy uses; data of a single strategy is in a PerGroup of that strategy.
struct GroupState {
  std::size_t id = 0;     ///< different for every group of a run
  Subassemblies members;  ///< in the order in which they are tried
  bool initial = false;   ///< the first group of the run, without the parts that have left it

  unsigned search_depth = 1;        ///< of the next round of path searches; grows by one with every unsuccessful round
  bool searches_exhausted = false;  ///< deeper rounds would find nothing more, or are not allowed
  Subassemblies waiting;  ///< members whose last search reached its depth limit, in the order of the next round

  unsigned pair_depth = 1;     ///< groups of two: depth of the last search of the pair, doubled each time
  bool pair_finished = false;  ///< groups of two: searched without limit, or deeper searches would find nothing more

  bool translations_limited = false;    ///< the last search for partial translations spent its budget
  bool translations_exhausted = false;  ///< that search visited all arrangements, and none frees a part

  /// Proof of the oracle that no translations separate its members, whichever of them move; null: none is known.
  const Certificate* proof = nullptr;

  bool contains(SubassemblyId member) const;
  bool is_pair() const { return members.size() == 2; }
};

/// A change of a group.
struct GroupChange {
  enum class Kind {
    removed,      ///< the moved subassemblies have left the group together
    translated,   ///< they were translated and stay in the group
    rotated,      ///< they were rotated in place and stay in the group
    one_removed,  ///< several moved simultaneously: one has left, the others stay in the group at their new poses
  };
  Kind kind = Kind::removed;
  Subassemblies moved;

  /// Did subassemblies move that stay in the group?
  bool moves_remaining() const {
    return kind == Kind::translated || kind == Kind::rotated || kind == Kind::one_removed;
  }
};

/// Receives every change.
class GroupListener {
 public:
  virtual ~GroupListener() = default;
  /// Called after poses have changed; `group.members` still has the subassemblies that leave.
  virtual void on_group_changed(GroupState& group, const GroupChange& change) = 0;
};

/// Data of one strategy by group.
template <class T>
class PerGroup {
 public:
  T& operator[](const GroupState& group) { return data_[group.id]; }
  const T* find(const GroupState& group) const {
    const auto known = data_.find(group.id);
    return known == data_.end() ? nullptr : &known->second;
  }

 private:
  std::map<std::size_t, T> data_;
};

/// Pairs that are known to be inseparable from the beginning.
using InseparablePairs = std::vector<std::pair<PartId, PartId>>;

class DisassemblyState {
 public:
  /// All references must outlive this.
  DisassemblyState(const SequenceQuery& query, const InseparablePairs& inseparable, PartOrder order,
                   SequenceObserver& observer, RunContext& context);

  const Assembly& assembly() const { return assembly_; }
  const Constraints& constraints() const { return constraints_; }
  RunContext& context() const { return context_; }
  const Eigen::Vector3d& up() const { return up_; }  ///< Objective::up
  /// Knows all removals that were committed.
  const Preference& preference() const { return preference_; }
  /// The same members of the group, those first that the objective likes best to leave next, whatever the direction.
  Subassemblies preferred(const GroupState& group, const Subassemblies& ids) const;
  /// `ids` leave the others of the group along `direction` (zero: not known).
  CandidateRemoval candidate(const GroupState& group, const Subassemblies& ids, const Eigen::Vector3d& direction) const;

  // Subassemblies.
  std::size_t subassemblies() const { return parts_.size(); }
  /// Ascending.
  const std::vector<PartId>& parts_of(SubassemblyId id) const { return parts_[id]; }
  std::vector<PartId> parts_of(const Subassemblies& ids) const;
  bool is_single(SubassemblyId id) const { return parts_[id].size() == 1; }
  /// Its only part, or the first.
  PartId part_of(SubassemblyId id) const { return parts_[id].front(); }
  SubassemblyId subassembly_of(PartId part) const { return of_part_[part]; }
  bool is_base(PartId part) const { return contains(constraints_.base, part); }
  /// Is a part of it proved inseparable from another?
  bool is_inseparable(SubassemblyId id) const;
  bool is_inseparable(PartId part) const { return inseparable_[part]; }
  /// The member with the largest box.
  SubassemblyId housing_of(const GroupState& group) const;

  // Poses.
  const Pose& pose(PartId part) const { return poses_[part]; }
  /// Number of the part's rotation in orientations().
  std::size_t orientation(PartId part) const { return orientation_[part]; }
  const Orientations& orientations() const { return orientations_; }
  void set_pose(PartId part, const Pose& pose);
  /// Grows when a part moves.
  std::uint64_t arrangement() const { return arrangement_; }

  // Groups.
  std::deque<GroupState>& waiting() { return waiting_; }
  const std::deque<GroupState>& waiting() const { return waiting_; }
  /// Do the constraints let `ids` leave the others of the group?
  bool may_leave(const GroupState& group, const Subassemblies& ids) const;
  /// The other members of the group, in its order.
  Subassemblies others(const GroupState& group, const Subassemblies& ids) const;
  /// The attempt to remove `ids` from the others of the group.
  Attempt attempt_for(const GroupState& group, const Subassemblies& ids) const;

  // Changes. Listeners receive each.
  void add_listener(GroupListener& listener) { listeners_.push_back(&listener); }
  /// Records a successful answer: the new poses, and which subassemblies have left the group.
  void commit(GroupState& group, const Subassemblies& ids, const Attempt& attempt, const AttemptResult& answer,
              GroupChange::Kind kind);

  // Progress and result.
  /// Should the run end? It was interrupted, or the target is removed.
  bool stop();
  bool interrupted() const { return interrupted_; }
  bool target_removed() const { return target_removed_; }
  void show_progress(PartId part) const;
  void count(const std::string& name, double amount = 1) { counts_[name] += amount; }
  const std::map<std::string, double>& counts() const { return counts_; }
  const std::vector<Removal>& removals() const { return removals_; }
  /// The last known failure of a part, for the report.
  void set_failure(Unsolved failure) { failures_[failure.part] = std::move(failure); }
  const Unsolved* failure_of(PartId part) const;
  const std::map<PartId, Unsolved>& failures() const { return failures_; }

 private:
  const Assembly& assembly_;
  Eigen::Vector3d up_;
  const Constraints& constraints_;
  SequenceObserver& observer_;
  RunContext& context_;
  Preference preference_;
  std::vector<std::vector<PartId>> parts_;  // by subassembly
  Subassemblies of_part_;                   // by part
  std::vector<bool> inseparable_;           // by part
  std::vector<Pose> poses_;                 // by part
  std::vector<std::size_t> orientation_;    // by part
  Orientations orientations_;
  std::uint64_t arrangement_ = 0;
  std::deque<GroupState> waiting_;
  std::size_t groups_ = 0;  // made so far
  std::vector<GroupListener*> listeners_;
  std::vector<Removal> removals_;
  std::size_t separations_ = 0;       // removals that split a group
  std::size_t most_separations_ = 0;  // when all are apart
  std::size_t parts_left_ = 0;        // that have not left a group
  std::map<PartId, Unsolved> failures_;
  std::map<std::string, double> counts_;
  bool interrupted_ = false, target_removed_ = false;
};

}  // namespace dismantle::blocking
