/// How deep a solid cuts into another one on a straight way, in one search over all of the way.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "depth_field.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// What to search for.
struct SweptSearch {
  double from = 0;                                          ///< only what is deeper is of interest
  std::function<double(double)> resolution;                 ///< of the answer, by the depth that is known; > 0
  double enough = std::numeric_limits<double>::infinity();  ///< the search ends at the first point so deep
  std::uint64_t most_pieces = 100'000;  ///< of the surface and the way; with more needed, it is not settled
  const Aabb* left_out = nullptr;       ///< points in it do not count, in the frame of either part; null: all do
};

struct SweptDepth {
  Penetration deepest;   ///< depth: search.from, if nothing deeper was found; point: world, where it is at that instant
  bool settled = false;  ///< nothing is deeper than `deepest` by more than the resolution
};

/// A closed solid in its first place.
struct PlacedSolid {
  const geometry::Solid& solid;
  Pose part;  ///< world
  DepthField& field;
};

/// The deepest point of the surface of one of two solids in the other while `a` moves by `along` (world). The depth of
/// a point depends on nothing but where it is, so that it is measured once for all of the way: a triangle sweeps a
/// prism, or a flat strip if it slides along itself.
SweptDepth swept_depth(const PlacedSolid& a, const Eigen::Vector3d& along, const PlacedSolid& b,
                       const SweptSearch& search, const RunContext& context);

}  // namespace dismantle
