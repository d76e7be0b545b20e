#include "configuration_cells/pocket.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "configuration_cells/pin_walk.h"
#include "configuration_cells/pose_flood.h"

namespace dismantle::immobility {
namespace {

// Parts that come so far are taken to come apart: of the radius, and assembly units, whichever is more.
constexpr double kFar = 1, kLeastFar = 3;

}  // namespace

std::optional<Pocket> pocket(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth,
                             const PocketEffort& effort, const RunContext& context) {
  if (!borderless(a) || !borderless(b)) return std::nullopt;
  const Pinned pinned(a, b, depth);
  if (pinned.pins().empty()) return std::nullopt;
  const double far = std::max(kFar * pinned.radius(), kLeastFar);
  PinWalk walk(pinned, far);
  walk.wander(effort.walk_checks, context);
  if (walk.away()) return std::nullopt;
  ForkJoin both(context);
  PoseFlood flood(pinned, walk, {0.5 * std::numbers::pi, 2 * far}, both);
  if (flood.run(effort.divisions, context) != PoseFlood::End::closed) return std::nullopt;
  return Pocket{flood.bounds().lo, flood.bounds().hi, flood.cells()};
}

}  // namespace dismantle::immobility
