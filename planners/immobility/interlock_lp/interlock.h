/// Proof that several parts hold each other in place: whichever of them move, none leaves a small region.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// Two bodies that are near each other, and their allowed penetration depth (> 0, assembly units).
struct Neighbours {
  std::size_t a = 0, b = 0;
  double depth = 0;
};

/// What a checker needs to bound all coordinates again by multiplication.
struct InterlockProof {
  std::vector<double> axes;         ///< quaternion w, x, y, z: of the coordinates, assembled = axes * ours
  std::vector<double> bounds;       ///< of each body but the first: 6 lower, 6 upper; rotation vector, then shift
  std::vector<double> pairs;        ///< a, b (positions of bodies), 6 lower and 6 upper bounds of a relative to b
  std::vector<double> rows;         ///< pair, 1: point of a, solid of the other, the point, direction; assembled frame
  std::vector<double> multipliers;  ///< of each bound, upper and lower in turn: their number, then row and multiplier
};

/// Bounds of the motions of all bodies relative to the first.
struct InterlockReach {
  double shift = 0;             ///< of the centre of a body's box; assembly units
  double turn = 0;              ///< rad
  std::size_t half_spaces = 0;  ///< that bound the region
  InterlockProof proof;
};

/// Do all motions of the bodies, also simultaneous ones, that begin assembled and along which no two neighbours
/// penetrate by their depth or more, stay within a region? Nothing: not proved. The proof succeeds where parts have
/// little play, and fails soon where they have much: fractions of a second up to a few. `spacing`: of interior samples;
/// assembly units, > 0. `max_rounds`: times that the bounds are widened.
///
/// The proof. Assume that the coordinates of all bodies, and of each neighbour relative to the other, are within
/// bounds. Then the interior samples of two neighbours keep their relative pose in half spaces (pair_rows()). These are
/// half spaces of the poses of all bodies, with a bound of the nonlinear remainder (relative_coordinates()). Linear
/// programs over them bound all coordinates. If every result is strictly within the assumed bound, no motion reaches
/// any of the bounds: it would have to reach one of them first, with all others kept. Bounds are widened until that is
/// so.
std::optional<InterlockReach> interlock(const std::vector<const std::vector<Solid>*>& bodies,
                                        const std::vector<Neighbours>& neighbours, double spacing, int max_rounds,
                                        const RunContext& context);

}  // namespace dismantle::immobility
