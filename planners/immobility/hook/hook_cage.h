/// A bent bar of one part through a hole of another, whose bends do not go through the hole.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/bar_middle.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// Two straight lines from one point, all within a solid. The surface of another part keeps the distance `keep[k]` from
/// the point k * step along either. Assembled frame.
struct Bend {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> along;  ///< unit
  double step = 0;
  std::vector<double> keep;  ///< > 0
};

/// How many are tried.
struct HookEffort {
  std::size_t holes = 4, bends = 3;  ///< bends: on each side of a hole
};

struct HookCage {
  Eigen::Vector3d hole = Eigen::Vector3d::Zero();  ///< a point of the bar, in the hole; assembled frame
  double width = 0;                                ///< diameter of the hole
  std::array<Bend, 2> bends;                       ///< on either side
};

/// Does `bar` with that middle, which is nowhere penetrated by more than `depth` (> 0), hang in a hole of `around`
/// between two bends that cannot pass? Nothing: not found within the effort, a few seconds at most.
///
/// Why it stays. The line along the middle of the bar from bend to bend is more than `depth` below its surface, so the
/// surface of the other part keeps out of it; and with it the border of a flat disc across the hole. How often the line
/// crosses the disc, even or odd, changes only when one of its ends crosses the disc, and is odd at first. The ends are
/// corners of bends. With the corner on the disc, each of the two lines of the bend has to lead out of the hole; that
/// leaves it certain directions (found by covering all places and directions with cells), and no two of these are so
/// far apart as the two lines are.
std::optional<HookCage> hook_cage(const Solid& bar, const std::vector<InnerBall>& middle, const Solid& around,
                                  double depth, const HookEffort& effort, const RunContext& context);

}  // namespace dismantle::immobility
