#include "dismantle/geometry/motion_samples.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {
namespace {

/// Samples vertices of the triangles of `a`. On long paths it uses only triangles in the box that `b` sweeps in the
/// frame of `a`; on short paths, finding those takes longer than all samples. Calls take(sample, point in the frame of
/// b) for samples inside `b` until it returns true; then returns true.
template <class Take>
bool sample(const Solid& a, const Solid& b, const RelativeMotion& motion, const RelativeMotion& backward,
            bool of_second, SampledTimes which, const Take& take) {
  if (a.open || b.open) return false;  // a point behind a wall may have come round it
  const std::size_t segments = motion.segments();
  const bool all = segments <= 12;
  const std::size_t times = all ? 24 : std::min<std::size_t>(2 * segments, 480);  // more samples rarely find more depth
  std::vector<std::uint32_t> near;
  if (!all) {
    a.bvh.overlapping(backward.swept_box(), [&](std::uint32_t t) { near.push_back(t); });
    std::sort(near.begin(), near.end());
  }
  const std::size_t triangles = all ? a.mesh.triangles.size() : near.size();
  for (std::size_t i = 0; i < times; ++i) {
    const bool among_some = i % 4 == 3;
    if (which == (among_some ? SampledTimes::others : SampledTimes::some)) continue;
    const double time = static_cast<double>(segments) * static_cast<double>(i + 1) / static_cast<double>(times);
    const Placement place(motion.at(time));
    // A different selection at each time, to cover more of the surface.
    const std::size_t count = std::min<std::size_t>(96, triangles);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t chosen = (k * triangles / count + i * 7919) % triangles, t = all ? chosen : near[chosen];
      const Eigen::Vector3d& p = a.mesh.vertex(t, static_cast<int>(i % 3));
      const Eigen::Vector3d x = place * p;
      if (!b.box.contains(x) || !b.bvh.inside(x)) continue;
      const double depth = b.bvh.closest(x).distance;
      if (take(Finding{Answer::violated, p, of_second, depth, a.thickness[t], time}, x)) return true;
    }
  }
  return false;
}

}  // namespace

Finding deepest_sample(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward) {
  Finding best;
  best.answer = Answer::violated;
  const auto take = [&](const Finding& f, const Eigen::Vector3d&) {
    if (f.depth > best.depth) best = f;
    return false;
  };
  sample(a, b, forward, backward, false, SampledTimes::all, take);
  sample(b, a, backward, forward, true, SampledTimes::all, take);
  return best;
}

bool sample_beyond(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, SampledTimes which) {
  const double sizes = a.box.size().norm() + b.box.size().norm();
  const auto beyond = [&](const Finding& f, const Eigen::Vector3d& x) {
    const Solid &of = f.of_second ? b : a, &in = f.of_second ? a : b;
    // Where a wall is without thickness, what touches is no deeper than rounding: that proves nothing.
    const double rounding = kRounding * (sizes + x.norm());
    return f.depth > std::max(limits.at(f.thickness), rounding) && !limits.exempts(of, f.point, in, x);
  };
  return sample(a, b, forward, backward, false, which, beyond) || sample(b, a, backward, forward, true, which, beyond);
}

}  // namespace dismantle::geometry
