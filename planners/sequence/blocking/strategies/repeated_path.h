/// Proposes the path of a removed part for its copies: screws, legs, clips, each in a seat of the same shape.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "blocking/parameters.h"
#include "blocking_graph/pair_sweep.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

/// A copy is a part with the same triangles elsewhere, or with a box of about the same size. Its path is the known
/// path, displaced as the part is. The path is valid if the seats are copies too, which the verifier decides. The
/// verification usually costs less than a search. Straight paths are left to free_part.
class RepeatedPath final : public Strategy {
 public:
  RepeatedPath(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep,
               const RepeatedPathParameters& params)
      : state_(state), oracle_(oracle), sweep_(sweep), params_(params) {}
  std::string_view name() const noexcept override { return "repeated_path"; }
  Cost cost() const noexcept override { return Cost::pair_sweeps; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  /// A part that was removed on a path found by a search.
  struct Known {
    PartId part = 0;
    const AttemptResult* answer = nullptr;  ///< of the oracle, with the path
  };
  /// The displacement from one part to the other, both as assembled.
  const std::optional<Pose>& displacement(PartId from, PartId to);
  bool is_refused(const GroupState& group, std::size_t known, PartId part) const;
  void extend(PartId part, const std::vector<PlacedPart>& others, Path& path) const;
  bool propose(GroupState& group, std::size_t known, SubassemblyId id);

  DisassemblyState& state_;
  PathOracle& oracle_;
  const PairSweep& sweep_;
  const RepeatedPathParameters& params_;
  std::vector<Known> known_;
  bool proposes_ = false;  ///< the change comes from this strategy
  std::map<std::pair<PartId, PartId>, std::optional<Pose>> displacements_;
  /// By path and part: the parts that blocked the refused proposal. Empty: unknown, or no copy.
  std::map<std::pair<std::size_t, PartId>, std::vector<PartId>> refused_;
  std::map<PartId, unsigned> refusals_;  ///< proposals that the verifier refused
};

}  // namespace dismantle::blocking
