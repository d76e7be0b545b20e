/// Translations to intermediate placements, found by a search over the arrangements of all parts of a group.
#pragma once

#include <cstdint>

#include "blocking/lattice_search.h"
#include "blocking/parameters.h"
#include "blocking/snap_fits.h"
#include "blocking/translation_search.h"
#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class PartialTranslation final : public Strategy {
 public:
  /// `straight`: null when straight removals are switched off; then only translations within the group are made.
  PartialTranslation(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep, StraightMotion* straight,
                     SnapFits& snaps, const PartialTranslationParameters& params);
  std::string_view name() const noexcept override { return "partial_translation"; }
  Cost cost() const noexcept override { return Cost::arrangements; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;
  std::string failure_note(const GroupState& group) const override;

 private:
  struct Progress {
    bool done = false;
    bool off_grid = false;  ///< the search on a grid does not suit the group, or the verifier refused what it found
    unsigned depth = 0;     ///< GroupState::search_depth at the last search
    std::string note;
  };
  /// Result of proposing one translation to the oracle.
  enum class Made { yes, refused, removed, impossible };
  bool suits(const GroupState& group) const;
  bool search(GroupState& group);
  TranslationSearch::Answer find(GroupState& group);
  void prove(GroupState& group);
  bool take_pair_apart(GroupState& group);
  std::optional<std::size_t> straight_direction(const Eigen::Vector3d& direction) const;
  Made make(GroupState& group, const Translation& slide);
  bool translate(GroupState& group, const Subassemblies& ids, const Eigen::Vector3d& by, const AttemptResult*& answer);
  void forbid(const GroupState& group, const Subassemblies& ids, const Eigen::Vector3d& direction,
              const AttemptResult* refusal);

  DisassemblyState& state_;
  PathOracle& oracle_;
  StraightMotion* straight_;
  SnapFits& snaps_;
  const PartialTranslationParameters& params_;
  TranslationSearch translations_;
  LatticeSearch on_grid_;
  PerGroup<Progress> progress_;
};

}  // namespace dismantle::blocking
