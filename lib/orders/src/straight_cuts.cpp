#include "straight_cuts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dismantle/geometry/boxes_along.h"
#include "dismantle/geometry/ray_depth.h"

namespace dismantle {

namespace {

using Eigen::Vector3d;

// As for the forced steps of `least_cut`, whose parameters say the same.
constexpr std::size_t kRays = 48;      // from vertices of each part
constexpr double kResolution = 8;      // of depths that are compared, in tolerances
constexpr double kShare = 0.1;         // the same as a share of the depth; the larger of the two applies
constexpr std::uint64_t kPoses = 200;  // measured for each pair

double support(const Aabb& box, const Vector3d& d) { return box.center().dot(d) + 0.5 * box.size().dot(d.cwiseAbs()); }

void keep_deeper(std::optional<MotionDepth>& worst, const std::optional<MotionDepth>& other) {
  if (other && (!worst || other->excess() > worst->excess())) worst = other;
}

bool beyond(const std::optional<MotionDepth>& depth, double enough) { return depth && depth->excess() > enough; }

}  // namespace

StraightCuts::StraightCuts(const Assembly& assembly, const Verifier& verifier)
    : assembly_(assembly), verifier_(verifier), meter_(assembly, verifier) {}

StraightCuts::Pair& StraightCuts::pair(PartId moving, PartId fixed, const Vector3d& out) {
  return pairs_[{moving, fixed, {out.x(), out.y(), out.z()}}];
}

double StraightCuts::reach(PartId moving, PartId fixed, const Vector3d& out) const {
  return support(assembly_.parts[fixed].mesh->box(), out) + support(assembly_.parts[moving].mesh->box(), -out);
}

bool StraightCuts::in_reach(PartId moving, PartId fixed, const Vector3d& out) const {
  return reach(moving, fixed, out) > 0 &&
         geometry::meets_along(assembly_.parts[moving].mesh->box(), assembly_.parts[fixed].mesh->box(), out);
}

/// Rays from vertices of each of the two through the other. Walls have no depth that a ray could find.
void StraightCuts::trace(PartId moving, PartId fixed, const Vector3d& out, std::optional<MotionDepth>& deepest) const {
  const double distance = reach(moving, fixed, out), allowed = assembly_.initial_overlap(moving, fixed);
  for (const bool forward : {true, false}) {
    const PartId from = forward ? moving : fixed, through = forward ? fixed : moving;
    const auto& vertices = assembly_.parts[from].mesh->vertices;
    const std::size_t stride = std::max<std::size_t>(1, vertices.size() / kRays);
    for (const geometry::Solid& solid : verifier_.solids(through)) {
      if (solid.open) continue;
      const Pose to_solid = solid.frame.inverse();
      const Vector3d along = to_solid.q * Vector3d(forward ? out : -out);
      for (std::size_t v = 0; v < vertices.size(); v += stride)
        geometry::depths_along(solid, to_solid * vertices[v], along, distance, [&](double depth, double s) {
          const Vector3d at = forward ? Vector3d(vertices[v] + s * out) : vertices[v];
          keep_deeper(deepest, MotionDepth{moving, fixed, depth, allowed, at, false});
        });
    }
  }
}

std::optional<MotionDepth> StraightCuts::by_rays(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                                 const Vector3d& out, double enough, const RunContext& context) {
  std::optional<MotionDepth> worst;
  for (const PartId p : moving)
    for (const PartId q : fixed) {
      if (context.should_stop() || !in_reach(p, q, out)) continue;
      Pair& known = pair(p, q, out);
      if (!known.traced) trace(p, q, out, known.by_ray);
      known.traced = true;
      keep_deeper(worst, known.by_ray);
      keep_deeper(worst, known.cut);
      if (beyond(worst, enough)) return worst;
    }
  return worst;
}

std::optional<MotionDepth> StraightCuts::measure(PartId moving, PartId fixed, const Vector3d& out,
                                                 const MotionDepthOptions& options, const RunContext& context) {
  const Pose end{reach(moving, fixed, out) * out, Pose{}.q};
  return meter_.deepest({moving}, {{fixed, Pose{}}}, {{Pose{}}, {end}}, options, context);
}

std::optional<MotionDepth> StraightCuts::deepest(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                                 const Vector3d& out, double enough, const RunContext& context) {
  std::optional<MotionDepth> worst = by_rays(moving, fixed, out, enough, context);
  if (beyond(worst, enough)) return worst;
  const double tolerance = verifier_.options().max_penetration;
  bool proved = true;
  worst.reset();
  for (const PartId p : moving)
    for (const PartId q : fixed) {
      if (!in_reach(p, q, out)) continue;
      Pair& known = pair(p, q, out);
      if (!known.whole && !beyond(known.cut, enough)) {
        known.cut = measure(p, q, out, {kResolution * tolerance, kShare, enough, kPoses}, context);
        if (context.should_stop()) return std::nullopt;
        known.whole = !beyond(known.cut, enough);
      }
      keep_deeper(worst, known.cut);
      proved = proved && (!known.cut || known.cut->proved);
      if (beyond(worst, enough)) return worst;
    }
  if (worst) worst->proved = proved;
  return worst;
}

std::optional<MotionDepth> StraightCuts::exactly(const std::vector<PartId>& moving, const std::vector<PartId>& fixed,
                                                 const Vector3d& out, const RunContext& context) {
  const double tolerance = verifier_.options().max_penetration;
  const std::optional<MotionDepth> rough =
      deepest(moving, fixed, out, std::numeric_limits<double>::infinity(), context);
  if (!rough) return rough;
  // A pair that is clearly less deep is not the deepest.
  const double unsure = std::max(kResolution * tolerance, kShare * rough->excess());
  std::optional<MotionDepth> worst;
  bool proved = rough->proved;
  for (const PartId p : moving)
    for (const PartId q : fixed) {
      if (!in_reach(p, q, out)) continue;
      const std::optional<MotionDepth> known = pair(p, q, out).cut;
      if (!known || known->excess() + unsure < rough->excess()) continue;
      const std::optional<MotionDepth> fine =
          measure(p, q, out, {.absolute = tolerance, .most_poses = 2 * kPoses}, context);
      if (context.should_stop()) return rough;
      keep_deeper(worst, fine);
      proved = proved && (!fine || fine->proved);
    }
  if (worst) worst->proved = proved;
  return worst ? worst : rough;
}

}  // namespace dismantle
