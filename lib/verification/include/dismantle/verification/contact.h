/// What kind of contact two parts have when assembled, measured on their original triangles.
#pragma once

#include <optional>

#include "dismantle/contact_class.h"
#include "dismantle/export.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Two parts as they stand.
struct PairContact {
  double depth = 0;           ///< as deepest_penetration(), in the unit of the meshes; 0: no overlap, or a duplicate
  OverlapPlace place;         ///< same unit, world; below `contact`, it means something only where they overlap
  bool first_inside = false;  ///< `inside`: the first lies in the solid of the second; else the second in the first
};

/// The class of two assembled parts, none when they are further apart than `near`.
///
/// `tolerance` (> 0): that of the depth. All lengths are in the unit of the meshes. In this order:
///   - `duplicate`: both boxes and both surfaces, at every corner and every middle of a triangle, are within a
///   thousandth
///     of the smaller part's diagonal of each other (at least twice the tolerance), and face the same way;
///   - `inside`: no corner or middle of one is further out of the other than twice the tolerance;
///   - an overlap, when the depth is more than twice the tolerance. The surfaces near each other are divided into
///   cells,
///     most of them where they overlap. Cells face the other part when their normal is within 45 degrees of the
///     opposite of the normal at the nearest point there. `share` is the area of facing cells in the other part as a
///     share of those that are in it or nearer than four depths (at least 2 % of the smaller part's diagonal).
///     `uniform_interference`: cells of half the depth or more are in each of eight equal sectors about an axis, square
///     to which they face; or `share` is at least a half, and their mean depth is at least half of the depth. All
///     others are `local_interference`;
///   - `kissing`: triangles come nearer than twice the tolerance; `clearance`: nearer than `near`.
/// Deterministic. A fixed number of cells bounds the work beyond one query per triangle nearby.
DISMANTLE_API std::optional<PairContact> classify_contact(const DepthBody& a, const DepthBody& b, double tolerance,
                                                          double near);

/// The same for two parts of which it is known that they do not overlap deeper: `duplicate`, `kissing`, `clearance` or
/// none.
DISMANTLE_API std::optional<ContactClass> classify_apart(const DepthBody& a, const DepthBody& b, double tolerance,
                                                         double near);

/// The same for two parts of which the depth is known and more than twice the tolerance.
DISMANTLE_API PairContact classify_overlap(const DepthBody& a, const DepthBody& b, const Penetration& deepest,
                                           double tolerance);

}  // namespace dismantle
