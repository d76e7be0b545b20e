/// Swept test of pairs: does one part pass another along a path?
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/geometry/hulls_apart.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// Continuous collision check of pairs by lib/geometry, with a small budget. The verifier uses the same check, so it
/// rarely refuses a path that passes here. An answer only orders the work: every path is proposed to the oracle. const
/// functions may be called from several threads.
class PairSweep {
 public:
  /// Both must outlive this. The oracle has a tolerance.
  PairSweep(const Assembly& assembly, PathOracle& oracle);

  /// Does `moving` pass `fixed` along `path` (>= 2 poses, joined by screw motions)? False: it does not, or the budget
  /// did not suffice for a proof.
  bool passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const {
    return !leaves_region(moving, fixed, fixed_at, path) &&
           passes(moving, fixed, fixed_at, path, assembly_.initial_overlap(moving, fixed));
  }
  /// The same for two parts that may cut into each other by `overlap`, as two others of these shapes do when assembled.
  bool passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path, double overlap) const;
  /// True if samples show that one cuts into the other outside the region in which they overlap when assembled. An
  /// overlap as deep as half a wall allows all depths in the wall, so only its region tells.
  bool leaves_region(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const;
  double overlap(PartId a, PartId b) const { return assembly_.initial_overlap(a, b); }
  /// The part as a copy of the first one of its shape, to within a ten-thousandth of the tolerance.
  const geometry::ShapePlacement& shape(PartId part) const { return shapes_[part]; }
  /// Distance along the unit vector `direction` after which the convex hulls of both groups are apart. Resolution: a
  /// 4096th of `most`, the distance after which they are assumed to be apart.
  double distance_apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest,
                        const Eigen::Vector3d& direction, double most) const;
  /// Corners of the convex hull of a part, in its assembled frame.
  const std::vector<Eigen::Vector3d>& hull(PartId part) const;
  std::size_t parts() const { return assembly_.parts.size(); }
  double tolerance() const { return tolerance_; }  ///< of the verifier; assembly units
  PartMemo& memo() const { return memo_; }         ///< of the oracle, if it shares one

 private:
  const std::vector<geometry::Solid>& solids(PartId part) const;
  std::vector<geometry::PlacedHull> hulls(const std::vector<PlacedPart>& parts) const;

  const Assembly& assembly_;
  double tolerance_;
  std::unique_ptr<PartMemo> own_;  // if the oracle shares none
  PartMemo& memo_;
  std::map<std::pair<PartId, PartId>, Aabb> regions_;                            // geometry::overlap_region(); a < b
  std::vector<Aabb> boxes_;                                                      // by part
  std::vector<geometry::ShapePlacement> shapes_;                                 // by part
  mutable std::vector<std::atomic<const std::vector<Eigen::Vector3d>*>> hulls_;  // by part, those that were asked for
};

}  // namespace dismantle::blocking
