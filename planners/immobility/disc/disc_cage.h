/// A flat piece of one part in a chamber of another, all of whose ways out are too small for it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/bar_middle.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// A flat disc within a solid. All that is nearer to it than `half` is deeper below the surface than was asked for.
/// Assembled frame.
struct InnerDisc {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double radius = 0, half = 0;
};

/// Large discs in the walls of a solid with that middle, `depth` (> 0) below its surface and more; the largest first.
std::vector<InnerDisc> discs_in(const Solid& solid, const std::vector<InnerBall>& middle, double depth,
                                std::size_t most);

/// How much is looked at before a proof is given up.
struct DiscEffort {
  std::size_t divisions = 60'000;    ///< of cells
  std::size_t facets = 200'000'000;  ///< about ten seconds; most is told with a tenth
};

struct DiscCage {
  InnerDisc disc;
  std::size_t cells = 0;  ///< that were looked at
};

/// Is the disc in a chamber of the solids that it cannot leave? Nothing: told to stop, or not found within the effort,
/// up to ten seconds. `depth` of discs_in() has to include what the parts overlap by when assembled: where the disc's
/// centre is nearer than `half` to a solid to begin with, nothing is found.
///
/// Why it cannot. What is nearer than `half` to the disc keeps off the solids: where a surface met it, that would be
/// deeper in the disc's part than is allowed, and it begins outside. So wherever the centre is, a solid is no nearer
/// than `half`. And a plane through the centre shares a diameter of the disc with it, whichever way the disc is turned:
/// if along no line in the plane through the centre there is room for a diameter, the centre cannot be there. Cells of
/// places that are shut out by either are cut away, until the rest around the centre at first is shut in. That a cell
/// is shut out is shown for all of it (see DiscRoom), not for samples.
std::optional<DiscCage> disc_cage(const InnerDisc& disc, const std::vector<Solid>& around, const DiscEffort& effort,
                                  const RunContext& context);

}  // namespace dismantle::immobility
