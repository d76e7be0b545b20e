/// Proof that two parts hold each other: a region of relative poses that none of their motions leaves.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/linear_bound.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

struct Pocket {
  /// Bounds of the region: rotation vector and shift of `a` seen from `b`, about the middle of `a`'s box.
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();
  std::size_t cells = 0;  ///< boxes of poses that the proof is made of
};

/// How much is looked at before a proof is given up.
struct PocketEffort {
  std::size_t walk_checks = 6000;   ///< poses, of the random walk to begin with
  std::size_t divisions = 100'000;  ///< of cells, in all
};

/// Does every motion of `a` past `b` that begins assembled and along which nothing cuts in by `depth` (> 0) or more
/// stay within a region? Nothing: not proved, with a fixed effort; or told to stop. Seconds up to half a minute; where
/// parts come free, a random walk mostly finds that in less.
///
/// The proof. Pins stay out of what they face. A box of poses around the assembled one is divided into cells; what pins
/// leave over of a cell is bounded by contract(). Two cells are neighbours when what is left of them touches. A motion
/// out of the box passes through neighbours up to its border. So when no chain of neighbours leads from the cell of the
/// assembled pose to the border, there is no such motion. Only cells on a chain that leads there are divided further.
/// Where chains keep leading to the same side, the box grows by a cell on that side, and the walk is sent there: what
/// it reaches has to be in the box, and where it comes out there is nothing to prove.
std::optional<Pocket> pocket(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth,
                             const PocketEffort& effort, const RunContext& context);

}  // namespace dismantle::immobility
