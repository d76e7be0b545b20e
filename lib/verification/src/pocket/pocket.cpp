#include "pocket/pocket.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "pocket/pin_walk.h"
#include "pocket/pose_flood.h"

namespace dismantle::verify {
namespace {

constexpr std::size_t kLooks = 6000;        // of the random walk, to begin with
constexpr std::size_t kDivisions = 100000;  // in all
// Parts that come so far are taken to come apart: of the radius, and assembly units, whichever is more.
constexpr double kFar = 1, kLeastFar = 3;

}  // namespace

std::optional<Pocket> pocket(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth,
                             const RunContext& context) {
  if (!borderless(a) || !borderless(b)) return std::nullopt;
  const Pinned pinned(a, b, depth);
  if (pinned.pins().empty()) return std::nullopt;
  const double far = std::max(kFar * pinned.radius(), kLeastFar);
  PinWalk walk(pinned, far);
  walk.wander(kLooks, context);
  if (walk.away()) return std::nullopt;
  ForkJoin both(context);
  PoseFlood flood(pinned, walk, {0.5 * std::numbers::pi, 2 * far}, both);
  if (flood.run(kDivisions, context) != PoseFlood::End::closed) return std::nullopt;
  return Pocket{flood.bounds().lo, flood.bounds().hi, flood.cells()};
}

}  // namespace dismantle::verify
