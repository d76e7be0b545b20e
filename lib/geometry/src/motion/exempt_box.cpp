// The exempt box of the limits: what of a patch needs no proof, because the depth has no limit there.
#include "exempt_box.h"

#include <algorithm>

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

/// True if no point of the solid is in the box, which is given in the assembled frame of the solid.
bool is_free(const Solid& solid, const Aabb& box) {
  const Placement to_local(solid.frame.inverse());
  const Vec3 c = to_local * box.center(), h = to_local.r.cwiseAbs() * (0.5 * box.size());
  bool met = false;
  solid.bvh.overlapping({c - h, c + h}, [&](std::uint32_t) { met = true; });
  return !met && !solid.bvh.inside(c);
}

}  // namespace

bool is_free_outside(const Solid& solid, const Aabb& box, const Aabb& inner) {
  Aabb rest = box;  // without the slabs that were looked at
  for (int axis = 0; axis < 3; ++axis) {
    if (rest.lo[axis] < inner.lo[axis]) {
      Aabb below = rest;
      below.hi[axis] = std::min(rest.hi[axis], inner.lo[axis]);
      if (!is_free(solid, below)) return false;
      rest.lo[axis] = inner.lo[axis];
    }
    if (rest.hi[axis] > inner.hi[axis]) {
      Aabb above = rest;
      above.lo[axis] = std::max(rest.lo[axis], inner.hi[axis]);
      if (!is_free(solid, above)) return false;
      rest.hi[axis] = inner.hi[axis];
    }
  }
  return true;
}

/// True if the whole patch is in the exempt box, in its own assembled frame or in B's during the interval.
bool DirectedCheck::exempt(const Interval& i, double margin, const Patch& patch) const {
  if (limits_.exempt == nullptr) return false;
  const auto inside = [&](const Corners& corners, const Pose& to_assembled, double inset) {
    Aabb box = *limits_.exempt;
    box.inflate(-inset);
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3& p) { return box.contains(to_assembled * p); });
  };
  if (inside(patch.p, a_.frame, 0)) return true;
  return inside(placed(i.at0, patch.p), b_.frame, margin) && inside(placed(i.at1, patch.p), b_.frame, margin);
}

/// True if all of B that the patch may meet in the interval is in the exempt box, in B's assembled frame. It settles
/// patches that stick out of the exempt box where there is nothing, which would otherwise be divided until they are
/// smaller than its border, at each instant.
bool DirectedCheck::meets_exempt_only(const Interval& i, double margin, const Patch& patch) const {
  if (limits_.exempt == nullptr) return false;
  Aabb swept;
  for (const Placement& place : {i.at0, i.at1})
    for (const Vec3& p : placed(place, patch.p)) swept.extend(b_.frame * p);
  swept.inflate(margin + kRounding * (a_.box.size().norm() + b_.box.size().norm()));
  return swept.overlaps(*limits_.exempt) && is_free_outside(b_, swept, *limits_.exempt);
}

/// True if the patch is partly in the exempt box, in its own assembled frame, and larger than the border is wide.
bool DirectedCheck::crosses_exempt(const Patch& patch) const {
  if (limits_.exempt == nullptr || patch.radius() <= limits_.border) return false;
  Aabb box;
  for (const Vec3& p : patch.p) box.extend(a_.frame * p);
  return box.overlaps(*limits_.exempt);
}

}  // namespace dismantle::geometry
