/// Search over the arrangements of parts that lie on a grid: interlocking puzzles without play, and burrs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blocking/translation_search.h"
#include "dismantle/lattice/arrangements.h"

namespace dismantle::blocking {

/// Every rigid group may slide along the axes of the grid, by any number of cells. A part fills the cells that its
/// surface touches, so the verifier may accept more than this search finds, and hardly ever refuses what it finds.
class LatticeSearch {
 public:
  /// `tolerance`: of the verifier, assembly units. `assembly` must outlive this.
  LatticeSearch(const Assembly& assembly, double tolerance) : assembly_(assembly), tolerance_(tolerance) {}

  /// Visits up to `most_states` arrangements; `most_work` is a number of arrangements looked up. The answer has the
  /// fewest translations until parts leave. `unsuited`: the parts, as placed, do not lie on a grid.
  TranslationSearch::Answer search(const Places& places, std::size_t most_states, double most_work,
                                   const RunContext& context);

  /// For the log.
  std::string summary(const TranslationSearch::Answer& answer) const;

 private:
  const std::vector<lattice::Cell>& cells(PartId part);

  const Assembly& assembly_;
  double tolerance_;
  std::optional<lattice::Lattice> lattice_;  ///< of the first group that has one
  std::map<PartId, std::vector<lattice::Cell>> cells_;
};

}  // namespace dismantle::blocking
