/// Proof that a flat piece of one part cannot leave a chamber of another.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "disc/disc.h"
#include "dismantle/aabb.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/medial_balls.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// A flat disc within a solid. All points nearer to it than `half` are deeper below the surface than a given depth.
/// Assembled frame.
struct InteriorDisc {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double radius = 0, half = 0;
};

/// Large discs in the walls of a solid, at least `depth` (> 0) below its surface; the largest first. `balls`: medial
/// balls of the solid.
std::vector<InteriorDisc> discs_in(const Solid& solid, const std::vector<MedialBall>& balls, double depth,
                                   std::size_t most);

struct DiscCage {
  InteriorDisc disc;
  Pose frame;                            ///< of the region: assembled = frame * local
  std::vector<Aabb> region;              ///< cells that the disc's centre does not leave
  std::vector<Eigen::Vector3d> normals;  ///< of the tested planes; assembled frame
};

/// Proves that the disc is in a chamber of the solids that it cannot leave. Returns nullopt when told to stop, or if
/// not proved with the effort of `params`, up to ten seconds. `depth` of discs_in() must include the initial overlap of
/// the parts: there is no proof if the disc's centre is nearer than `half` to a solid when assembled. `slack` (> 0,
/// much less than `half`): length reserved for rounding.
///
/// Why it cannot leave: a surface of the solids that came nearer than `half` to the disc would be deeper in the disc's
/// part than is allowed, and it begins outside. So no solid is ever nearer than `half` to the centre. Whatever its
/// orientation, the disc has a diameter in any given plane through its centre. So the centre cannot be where no line of
/// that plane through it has room for a diameter. Cells of positions that one of these two conditions excludes are
/// removed, until the remaining cells around the assembled position are cut off from the border. A cell is excluded
/// only if all of its points are (see DiameterClearance).
std::optional<DiscCage> disc_cage(const InteriorDisc& disc, const std::vector<Solid>& around, double slack,
                                  const DiscParameters& params, const RunContext& context);

}  // namespace dismantle::immobility
