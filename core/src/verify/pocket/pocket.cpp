#include "verify/pocket/pocket.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "verify/pocket/pin_walk.h"
#include "verify/pocket/pose_flood.h"

namespace dismantle::verify {
namespace {

constexpr std::size_t kLooks = 8000;       // of the random walk
constexpr std::size_t kDivisions = 24000;  // in all, about
constexpr std::size_t kFirstShare = 8000;
constexpr int kBoxes = 16;             // one larger than the other
constexpr double kMargin = 0.5;        // of what the walk reached, on either side, ...
constexpr double kLeastMargin = 0.02;  // ... and assembly units
// Parts that come so far are taken to come apart: of the radius, and assembly units, whichever is more.
constexpr double kFar = 0.3, kLeastFar = 1;

}  // namespace

std::optional<Pocket> pocket(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth,
                             const RunContext& context) {
  if (!borderless(a) || !borderless(b)) return std::nullopt;
  const Pinned pinned(a, b, depth);
  if (pinned.pins().empty()) return std::nullopt;
  const double far = std::max(kFar * pinned.radius(), kLeastFar);
  const PinWalk walk = walk_with_pins(pinned, kLooks, far, context);
  if (walk.away) return std::nullopt;
  Vector6 lo = walk.lo, hi = walk.hi;
  for (int d = 0; d < 6; ++d) {
    const double margin = kMargin * (hi[d] - lo[d]) + kLeastMargin / (d < 3 ? pinned.radius() : 1.0);
    lo[d] -= margin;
    hi[d] += margin;
  }
  PinList in_use = walk.met;
  Contractor contractor(pinned, context.threads);
  std::size_t divisions = 0, share = kFirstShare;
  bool grown = false;
  for (int box = 0; box < kBoxes && divisions < kDivisions; ++box) {
    PoseFlood flood(pinned, in_use, lo, hi, contractor);
    PoseFlood::End end = flood.run(share, context);
    // A box whose sides the parts were seen to reach, or nearly so, is as large as it need be.
    if (end == PoseFlood::End::spent && grown) end = flood.run(2 * share, context);
    grown = end == PoseFlood::End::at_edge;
    if (end == PoseFlood::End::closed) return Pocket{flood.bounds().lo, flood.bounds().hi, flood.cells()};
    if (end == PoseFlood::End::open) return std::nullopt;
    divisions += flood.cells() / 2;
    if (end == PoseFlood::End::spent) share *= 2;
    in_use = flood.in_use();
    lo = flood.bounds().lo;
    hi = flood.bounds().hi;
    const double turn = std::max(-lo.head<3>().minCoeff(), hi.head<3>().maxCoeff());
    const double shift = std::max(-lo.tail<3>().minCoeff(), hi.tail<3>().maxCoeff());
    if (turn > 0.5 * std::numbers::pi || shift > 2 * far) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace dismantle::verify
