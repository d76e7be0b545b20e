/// Search over the arrangements of parts that lie on a grid: interlocking puzzles without play, and burrs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blocking/translation_search.h"
#include "blocking_graph/pair_sweep.h"
#include "dismantle/lattice/arrangements.h"

namespace dismantle::blocking {

/// Every rigid group may slide along the axes of the grid, by any number of cells. Two parts are never in the same full
/// cell. Where they share cells that a curved outside or a chamfer cuts through, their surfaces decide.
class LatticeSearch {
 public:
  /// Both must outlive this.
  LatticeSearch(const Assembly& assembly, const PairSweep& sweep)
      : assembly_(assembly), sweep_(sweep), tolerance_(sweep.tolerance()) {}

  /// Visits up to `most_states` arrangements; `most_work` is a number of arrangements looked up. The answer has the
  /// fewest translations until parts leave. `unsuited`: the parts, as placed, do not lie on a grid.
  TranslationSearch::Answer search(const Places& places, std::size_t most_states, double most_work,
                                   const RunContext& context);

  /// For the log.
  std::string summary(const TranslationSearch::Answer& answer) const;

 private:
  const lattice::PieceCells& cells(PartId part);
  bool passes(PartId moving, PartId fixed, const Eigen::Vector3d& at, const Eigen::Vector3d& by) const;

  const Assembly& assembly_;
  const PairSweep& sweep_;
  double tolerance_;                         ///< of the verifier; assembly units
  std::optional<lattice::Lattice> lattice_;  ///< of the first group that has one
  std::map<PartId, lattice::PieceCells> cells_;
  std::size_t asked_ = 0;  ///< pairs of surfaces, in the last search
};

}  // namespace dismantle::blocking
