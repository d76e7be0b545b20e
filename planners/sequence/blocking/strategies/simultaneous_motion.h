/// Moves two or three parts simultaneously, each along its own path, until one is removed: for interlocks in which no
/// part can move alone.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "blocking/lookahead.h"
#include "blocking/parameters.h"
#include "blocking/search_history.h"
#include "blocking/snap_fits.h"
#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

/// Three rounds: pairs to depth 1, before single parts are searched deeper; then larger sets, which are expensive; then
/// deeper searches of sets in which more than one part moved. Until the searches for single parts are over, a set waits
/// while simultaneous motions have cost more than a share (`simultaneous_share`) of these searches.
class SimultaneousMotion final : public Strategy {
 public:
  /// `play`: a part that has moved by less does not count as moved; assembly units.
  SimultaneousMotion(DisassemblyState& state, PathOracle& oracle, StraightMotion& straight, const Lookahead& lookahead,
                     const SearchHistory& history, SnapFits& snaps, PairRelaxation& relaxation,
                     const SimultaneousMotionParameters& params, unsigned max_depth, double play);
  std::string_view name() const noexcept override { return "simultaneous_motion"; }
  Cost cost() const noexcept override { return Cost::limited_search; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;
  std::string failure_note(const GroupState& group) const override;

 private:
  struct Progress {
    unsigned rounds = 0;            ///< finished rounds
    std::set<Subassemblies> tried;  ///< in the current round
    std::string note;
  };
  struct PastMotion {
    unsigned depth = 0;
    Outcome outcome = Outcome::exhausted;
    std::vector<PartId> blocked_by;
    bool several_moved = false;
  };
  std::vector<Subassemblies> candidate_sets(const GroupState& group);
  unsigned depth_of(unsigned round) const;
  std::optional<Attempt> attempt_for(const GroupState& group, const Subassemblies& ids, unsigned round) const;
  bool is_worthwhile(const GroupState& group, const Subassemblies& ids, unsigned round);
  bool is_held_pair(const GroupState& group, const Subassemblies& ids, unsigned round);
  bool is_held(const GroupState& group, SubassemblyId id) const;
  bool can_afford(const GroupState& group) const;
  bool move(GroupState& group, const std::vector<Subassemblies>& sets, std::size_t k, unsigned round);
  bool several_moved(const Attempt& attempt, const std::vector<Pose>& reached) const;

  DisassemblyState& state_;
  PathOracle& oracle_;
  StraightMotion& straight_;
  const Lookahead& lookahead_;
  const SearchHistory& history_;
  SnapFits& snaps_;
  PairRelaxation& relaxation_;
  const SimultaneousMotionParameters& params_;
  double play_;
  unsigned max_depth_;
  PerGroup<Progress> progress_;
  std::map<Subassemblies, PastMotion> last_;
  double work_ = 0;           // of unsuccessful motions, in the unit of SearchHistory::work()
  bool unsupported_ = false;  // by the path planner or the simulator
};

}  // namespace dismantle::blocking
