/// Proof that a bent bar of one part cannot leave a hole of another, because its bends do not pass the hole.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/medial_balls.h"
#include "dismantle/run_context.h"
#include "hook/hook.h"

namespace dismantle::immobility {

/// Two straight legs from one corner, within a solid. The surface of another part is never nearer than `keep[k]` to the
/// point k * step along either leg. Assembled frame.
struct Bend {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> along;  ///< unit
  double step = 0;
  std::vector<double> keep;  ///< > 0
};

struct HookCage {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the disc across the hole
  std::vector<Eigen::Vector3d> path;                  ///< the line from bend to bend
  Eigen::Vector3d hole = Eigen::Vector3d::Zero();     ///< a point of the bar in the hole; assembled frame
  double width = 0;                                   ///< diameter of the hole
  std::array<Bend, 2> bends;                          ///< one on each side
};

/// Proves that `bar`, which nothing penetrates by more than `depth` (> 0), is held in a hole of `around` between two
/// bends that cannot pass. `balls`: medial balls of the bar. Returns nullopt if not proved with the effort of `params`,
/// a few seconds at most.
///
/// Why it stays: the line along the middle of the bar from bend to bend is more than `depth` below its surface, so the
/// surface of the other part never meets it. Nor does the border of a flat disc across the hole, which is on that
/// surface. The line crosses the disc an odd number of times at first, and this parity changes only when one of its
/// ends crosses the disc. The ends are corners of bends. With the corner on the disc, each leg of the bend has to lead
/// out of the hole. A cover of all positions and directions by cells gives the directions in which a leg can do so. No
/// two of these differ by as much as the legs do.
std::optional<HookCage> hook_cage(const Solid& bar, const std::vector<MedialBall>& balls, const Solid& around,
                                  double depth, const HookParameters& params, const RunContext& context);

}  // namespace dismantle::immobility
