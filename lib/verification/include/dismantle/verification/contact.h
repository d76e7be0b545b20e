/// Classifies the contact of two assembled parts, measured on their original triangles.
#pragma once

#include <optional>

#include "dismantle/contact_class.h"
#include "dismantle/export.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Contact of two assembled parts.
struct PairContact {
  double depth = 0;           ///< as deepest_penetration(), in the unit of the meshes; 0: no overlap, or a duplicate
  OverlapPlace place;         ///< same unit, world; fields other than `contact` are valid only for overlaps
  bool first_inside = false;  ///< for class `inside`: the first part lies in the second; false: the second in the first
};

/// Contact class of two assembled parts; nullopt when they are further apart than `near`.
///
/// `tolerance` (> 0) is that of the depth. All lengths are in the unit of the meshes. The first class that applies
/// counts:
///   - `duplicate`: boxes and surfaces agree within a thousandth of the smaller part's diagonal (at least twice the
///     tolerance), and face the same way; tested at every vertex and at the centre of every triangle;
///   - `inside`: no vertex or triangle centre of one part is further outside the other than twice the tolerance;
///   - an overlap, when the depth is more than twice the tolerance. The surfaces near each other are divided into
///     cells, most of them where the parts overlap. A cell faces the other part when its normal is within 45 degrees
///     of the opposite of the normal at the nearest point there. `share` is the area of facing cells in the other part,
///     divided by that of facing cells in it or nearer than four depths (at least 2 % of the smaller part's diagonal).
///     `uniform_interference`: each of eight equal sectors about an axis has cells of at least half the depth that
///     face away from the axis or towards it; or `share` and the mean depth divided by the depth are at least a half.
///     All other overlaps are `local_interference`;
///   - `kissing`: triangles are nearer than twice the tolerance; `clearance`: nearer than `near`.
/// Deterministic. A fixed number of cells bounds the work beyond one query per triangle nearby.
DISMANTLE_API std::optional<PairContact> classify_contact(const DepthBody& a, const DepthBody& b, double tolerance,
                                                          double near);

/// The same for two parts known not to overlap by more than that: `duplicate`, `kissing`, `clearance` or nullopt.
DISMANTLE_API std::optional<ContactClass> classify_apart(const DepthBody& a, const DepthBody& b, double tolerance,
                                                         double near);

/// The same for two parts whose depth is known and exceeds twice the tolerance.
DISMANTLE_API PairContact classify_overlap(const DepthBody& a, const DepthBody& b, const Penetration& deepest,
                                           double tolerance);

}  // namespace dismantle
