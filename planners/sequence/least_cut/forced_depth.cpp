// How deep the motions of forced steps cut in: samples first, then a measurement along the whole path.
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/ray_depth.h"
#include "dismantle/geometry/solid.h"
#include "least_cut/forced_motions.h"

namespace dismantle::least_cut {

std::optional<MotionDepth> ForcedMotions::depth(const ForcedMotion& motion, const MotionDepthOptions& options,
                                                const RunContext& context) {
  if (std::isfinite(options.stop_above)) {
    // Measuring a deep overlap completely takes seconds for large parts; a witness is enough to show that a motion cuts
    // in deeper than another.
    const auto witness = least_depth(motion, options.stop_above);
    if (witness && witness->excess() > options.stop_above) return witness;
  }
  ForcingOracle& oracle = *oracle_.forcing();
  if (!motion.straight()) return oracle.depth(ids_of(motion.moving), motion.fixed, path(motion), options, context);
  std::optional<MotionDepth> worst;
  bool proved = true;
  for (const PlacedPart& p : motion.moving)
    for (const PlacedPart& q : motion.fixed) {
      // The other part moving the other way cuts in as deep; only the final measurement states a point.
      const bool swapped = options.absolute > oracle_.tolerance() && p.part > q.part;
      const PlacedPart &moving = swapped ? q : p, &fixed = swapped ? p : q;
      const Eigen::Vector3d along = swapped ? Eigen::Vector3d(-motion.twist.linear) : motion.twist.linear;
      Known& pair = known(moving, fixed, along);
      const bool too_deep = pair.depth && pair.depth->excess() > options.stop_above;
      if (!too_deep && pair.resolution > options.absolute) {
        if (context.should_stop()) return worst;
        const double distance = reach(fixed, along) + reach(moving, -along);
        if (distance <= 0) continue;
        const Pose end{moving.pose.t + distance * along, moving.pose.q};
        MotionDepthOptions own = options;
        // What is stated leaves out the pairs that the verifier leaves out.
        own.known_invalid = pair.blocked > params_.blocking_share && options.absolute > oracle_.tolerance();
        pair.depth = oracle.depth({moving.part}, {fixed}, {{moving.pose}, {end}}, own, context);
        const bool to_the_end = !context.should_stop() && (!pair.depth || pair.depth->excess() <= options.stop_above);
        if (to_the_end) pair.resolution = options.absolute;
      }
      if (!pair.depth) continue;
      proved = proved && pair.depth->proved;
      if (!worst || pair.depth->excess() > worst->excess()) {
        worst = pair.depth;
        worst->part = p.part;
        worst->other = q.part;
      }
      worst->proved = false;
      if (worst->excess() > options.stop_above) return worst;
    }
  if (worst) worst->proved = proved;
  return worst;
}

std::optional<MotionDepth> ForcedMotions::least_depth(const ForcedMotion& motion, double enough) const {
  std::optional<MotionDepth> worst;
  if (!motion.straight()) return worst;
  const Eigen::Vector3d& along = motion.twist.linear;
  // Rays from points of `of` through `in`; `sign`: 1 along the motion, -1 against it.
  const auto trace_rays = [&](const PlacedPart& of, const PlacedPart& in, double sign, double distance) {
    const bool moves = sign > 0;
    const double allowed = assembly_.initial_overlap(of.part, in.part);
    const auto& vertices = assembly_.parts[of.part].mesh->vertices;
    const std::size_t stride = std::max<std::size_t>(1, vertices.size() / params_.depth_samples);
    for (const geometry::Solid& solid : solids(in.part)) {
      const Pose back = (in.pose * solid.frame).inverse();
      const Eigen::Vector3d local = back.q * Eigen::Vector3d(sign * along);
      for (std::size_t v = 0; v < vertices.size(); v += stride) {
        if (worst && worst->excess() > enough) return;
        const Eigen::Vector3d x = of.pose * vertices[v];
        geometry::depths_along(solid, back * x, local, distance, [&](double depth, double s) {
          const MotionDepth here{moves ? of.part : in.part,
                                 moves ? in.part : of.part,
                                 depth,
                                 allowed,
                                 moves ? Eigen::Vector3d(x + s * along) : x,
                                 false};
          if (!worst || here.excess() > worst->excess()) worst = here;
        });
      }
    }
  };
  for (const PlacedPart& p : motion.moving)
    for (const PlacedPart& q : motion.fixed) {
      const double distance = reach(q, along) + reach(p, -along);
      if (distance <= 0 || !in_reach(p, q, along, distance)) continue;
      trace_rays(p, q, 1, distance);
      trace_rays(q, p, -1, distance);
      if (worst && worst->excess() > enough) return worst;
    }
  return worst;
}

}  // namespace dismantle::least_cut
