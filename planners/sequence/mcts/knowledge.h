/// What the answers of the oracle say about the parts that are left, and what is to be expected of the next questions.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::mcts {

/// One part, as far as it is known.
struct PartKnowledge {
  bool gone = false;
  bool closed = false;             ///< failed, and nothing has left since: the same question has the same answer
  bool limited = false;            ///< its last search ended at its depth limit: a deeper one is another question
  unsigned depth = 1;              ///< of the next search
  double cost = 0;                 ///< of the last search; 0: none yet
  std::vector<PartId> blockers{};  ///< what the last search, which failed, met
  std::size_t left = 0;            ///< parts that were left then
};

/// A sequence of questions, real or imagined. Copies are cheap: simulations work on them.
class Knowledge {
 public:
  /// `max_depth`: of searches; 0 = no limit.
  Knowledge(std::size_t parts, unsigned max_depth) : parts_(parts), left_(parts), max_depth_(max_depth) {}

  std::size_t left() const { return left_; }
  const PartKnowledge& operator[](PartId part) const { return parts_[part]; }
  /// Parts whose next question may have a new answer, ascending.
  std::vector<PartId> open() const;

  void removed(PartId part, double cost);
  /// An answer that is no success. `blocked_by`: what the search met.
  void failed(PartId part, Outcome outcome, const std::vector<PartId>& blocked_by, double cost);
  /// The same in a simulation, which changes no means: it leaves, or it fails for the reason that it had before.
  void imagine_removal(PartId part);
  void imagine_failure(PartId part);

  /// Chance in [0, 1] that `part`, which is open, leaves if it is asked for now. Of a part that never failed, the share
  /// of successes so far (Laplace's rule). Of others that, times the share of what was in the way that has left since;
  /// where the search was limited, each level of depth has half the chance of the one before.
  double chance(PartId part) const;
  /// Cost of the question, in means of all costs so far: twice the last one where it goes deeper.
  double cost(PartId part) const;

 private:
  std::vector<PartKnowledge> parts_;
  std::size_t left_;
  unsigned max_depth_;
  double asked_ = 0, successes_ = 0, spent_ = 0;
};

}  // namespace dismantle::mcts
