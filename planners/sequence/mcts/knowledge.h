/// The answers of the oracle so far, and estimates of success and cost of the next searches.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::mcts {

struct PartKnowledge {
  bool gone = false;
  bool closed = false;             ///< its search failed and no part has left since: the same search would fail again
  bool limited = false;            ///< its last search ended at its depth limit: a deeper one may succeed
  unsigned depth = 1;              ///< of the next search
  double cost = 0;                 ///< of the last search; 0: none yet
  std::vector<PartId> blockers{};  ///< parts that the last, unsuccessful search met
  std::size_t left = 0;            ///< number of parts that were left at that time
};

/// The state after a sequence of searches, real or simulated. Copies are cheap; simulations work on copies.
class Knowledge {
 public:
  /// `parts`: of the assembly; those outside of `group` are gone. `max_depth`: of searches; 0 = no limit.
  Knowledge(std::size_t parts, const std::vector<PlacedPart>& group, unsigned max_depth)
      : parts_(parts, PartKnowledge{.gone = true}), left_(group.size()), max_depth_(max_depth) {
    for (const PlacedPart& p : group) parts_[p.part].gone = false;
  }

  std::size_t left() const { return left_; }
  const PartKnowledge& operator[](PartId part) const { return parts_[part]; }
  /// Parts whose next search may have a new result, ascending.
  std::vector<PartId> open() const;

  void removed(PartId part, double cost);
  /// Records an unsuccessful search. `blocked_by`: parts that it met.
  void failed(PartId part, Outcome outcome, const std::vector<PartId>& blocked_by, double cost);
  /// The same in a simulation: the observed rates and costs stay unchanged.
  void imagine_removal(PartId part);
  void imagine_failure(PartId part);

  /// Estimated probability that a search for `part`, which is open, succeeds now. For a part that never failed: the
  /// share of successes so far (Laplace's rule). For others: that, times the share of its blockers that have left
  /// since. After a search that ended at its depth limit, each further level has half the probability of the one
  /// before.
  double chance(PartId part) const;
  /// Estimated cost of the next search for `part`, in units of the mean cost so far: the cost of the last search,
  /// doubled if the next one goes deeper.
  double cost(PartId part) const;

 private:
  std::vector<PartKnowledge> parts_;
  std::size_t left_;
  unsigned max_depth_;
  double asked_ = 0, successes_ = 0, spent_ = 0;
};

}  // namespace dismantle::mcts
