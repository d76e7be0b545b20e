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

/// Data from which a checker bounds all coordinates by multiplication only.
struct InterlockProof {
  std::vector<double> axes;         ///< quaternion w, x, y, z of the coordinate axes: assembled = axes * local
  std::vector<double> bounds;       ///< of each body but the first: 6 lower, 6 upper; rotation vector, then shift
  std::vector<double> pairs;        ///< a, b (indices of bodies), 6 lower and 6 upper bounds of a relative to b
  std::vector<double> rows;         ///< pair, 1: point of a, solid of the other, the point, direction; assembled frame
  std::vector<double> multipliers;  ///< by bound, upper and lower in turn: count, then row and multiplier
};

/// Bounds of the motions of all bodies relative to the first.
struct InterlockReach {
  double shift = 0;             ///< of the centre of a body's box; assembly units
  double turn = 0;              ///< rad
  std::size_t half_spaces = 0;  ///< that bound the region
  InterlockProof proof;
};

/// Considers motions of the bodies, also simultaneous ones, that begin assembled and along which all neighbours
/// penetrate by less than their depth. Finds a region that none of them leaves, or returns nullopt. The proof succeeds
/// only for parts with little clearance, else it fails early; it takes up to a few seconds. `spacing`: of interior
/// samples; assembly units, > 0. `max_rounds`: how often the bounds may be widened.
///
/// The proof. Assume that the coordinates of all bodies, and of each neighbour relative to the other, are within
/// bounds. Then the interior samples of two neighbours restrict their relative pose to half spaces (pair_rows()). These
/// are half spaces of the poses of all bodies, with a bound of the nonlinear remainder (relative_coordinates()). Linear
/// programs over them bound all coordinates. If every result is strictly within the assumed bound, no motion reaches
/// any of the bounds: it would have to reach one of them first, with all others kept. Bounds are widened until this
/// holds.
std::optional<InterlockReach> interlock(const std::vector<const std::vector<Solid>*>& bodies,
                                        const std::vector<Neighbours>& neighbours, double spacing, int max_rounds,
                                        const RunContext& context);

}  // namespace dismantle::immobility
