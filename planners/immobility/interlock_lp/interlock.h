/// Proof that several parts hold each other in place: none of their motions, whoever moves, gets out of a small region.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// Two bodies that are near each other, and how deep they may cut into each other (> 0, assembly units).
struct Neighbours {
  std::size_t a = 0, b = 0;
  double depth = 0;
};

/// How far bodies get, seen from the first.
struct InterlockReach {
  double shift = 0;             ///< of the middle of a body's box; assembly units
  double turn = 0;              ///< rad
  std::size_t half_spaces = 0;  ///< that bound the region
};

/// Do all motions of the bodies, any of them at once, that begin assembled and along which no two neighbours cut in by
/// their depth or more, stay within a region that is found here? Nothing: not proved. It is provable where parts have
/// little play, and soon told where they have not: fractions of a second up to a few.
///
/// The proof. Let the coordinates of all bodies and of each neighbour seen from the other be within bounds. Then the
/// pins of two neighbours keep their relative pose in half spaces (pair_rows()), which are half spaces of the poses of
/// all bodies, too, with a bound of what is not linear (seen_from()). Linear programs bound all coordinates over these.
/// If every one of them stays strictly within its bound, no motion gets to any of the bounds: it would have to be at
/// one of them first, with all others kept. Bounds are widened until that is so.
std::optional<InterlockReach> interlock(const std::vector<const std::vector<Solid>*>& bodies,
                                        const std::vector<Neighbours>& neighbours, int max_rounds,
                                        const RunContext& context);

}  // namespace dismantle::immobility
