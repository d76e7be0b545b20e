// The exempt box of the limits: what of a patch needs no proof, because the depth has no limit there.
#include "exempt_box.h"

#include <algorithm>

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

/// Beyond each face of the box, the hull is convex: it holds nothing of the solid if it meets no triangle and one of
/// its points is outside.
bool is_free_outside(const Solid& solid, const Sweep& hull, const Aabb& inner) {
  const Pose to_local = solid.frame.inverse();
  const double rounding = kRounding * (solid.box.size().norm() + inner.lo.norm() + inner.hi.norm());
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = to_local.q * Vec3(side * Vec3::Unit(axis));
      const double at = side * (side < 0 ? inner.lo : inner.hi)[axis] + normal.dot(to_local.t) - rounding;
      const std::optional<Vec3> point = hull.beyond({normal, at});
      if (point && (!hull.clear_beyond(solid.bvh, {normal, at}) || solid.bvh.inside(*point))) return false;
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
/// patches that stick out of the exempt box where there is nothing, which would otherwise be cut at its faces, for
/// nothing.
bool DirectedCheck::meets_exempt_only(const Interval& i, double margin, const Patch& patch) const {
  if (limits_.exempt == nullptr) return false;
  const Corners begin = placed(i.at0, patch.p), end = placed(i.at1, patch.p);
  Aabb swept;
  for (const Corners* corners : {&begin, &end})
    for (const Vec3& p : *corners) swept.extend(b_.frame * p);
  swept.inflate(margin);
  const double rounding = kRounding * (a_.box.size().norm() + b_.box.size().norm());
  return swept.overlaps(*limits_.exempt) && is_free_outside(b_, Sweep(begin, end, margin + rounding), *limits_.exempt);
}

/// Where to cut a patch that is partly in the exempt box, in its own assembled frame: on an edge that crosses a face of
/// the box. What is cut off outside does not reach into the box, up to rounding.
std::optional<Ridge> DirectedCheck::exempt_border(const Patch& patch) const {
  if (limits_.exempt == nullptr) return std::nullopt;
  const Aabb& box = *limits_.exempt;
  const double rounding = kRounding * (a_.box.size().norm() + box.lo.norm() + box.hi.norm());
  const Corners p{a_.frame * patch.p[0], a_.frame * patch.p[1], a_.frame * patch.p[2]};
  Aabb own, inner = box;
  for (const Vec3& corner : p) own.extend(corner);
  inner.inflate(-2 * rounding);
  if (!own.overlaps(inner)) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool low : {true, false}) {
      const double face = low ? box.lo[axis] + rounding : box.hi[axis] - rounding;
      for (std::size_t i = 0; i < 3; ++i) {
        const double from = p[i][axis] - face, to = p[(i + 1) % 3][axis] - face;
        // A corner on the face is on neither side.
        if (from * to < 0 && std::min(std::abs(from), std::abs(to)) > rounding) return Ridge{i, from / (from - to)};
      }
    }
  return std::nullopt;
}

}  // namespace dismantle::geometry
