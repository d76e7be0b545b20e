#include "dismantle/fasteners/strands.h"

namespace dismantle::fasteners {

std::optional<Flexible> strand_kind(const geometry::Strand& strand) {
  if (strand.share > 1.05) return std::nullopt;  // more than its volume: a hollow strand is a pipe
  // A loop has no ends, so its strand is all of its volume. Its section is round: that of a hexagon has a roundness of
  // 0.907, that of a square 0.785. Rings of bearings, washers and frames have flatter ones.
  if (strand.closed && strand.share >= 0.95 && strand.roundness >= 0.88) return Flexible::loop;
  // The ends of springs are ground, or lie on the coils beside them: a quarter of the volume may be in them. Hooks,
  // clips and handles have less than two full turns.
  if (strand.share >= 0.75 && strand.coils >= 2) return Flexible::coil;
  return std::nullopt;
}

}  // namespace dismantle::fasteners
