/// Can one part be moved past another? The question that most strategies begin with.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dismantle/geometry/hulls_apart.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// Continuous collision check of pairs by lib/geometry, with a small budget. The verifier is built on the same check,
/// so what passes here is rarely refused there. An answer only orders the work: each path is proposed to the oracle as
/// a whole. const functions may be called from several threads.
class PairSweep {
 public:
  /// Both must outlive this. The oracle has a tolerance.
  PairSweep(const Assembly& assembly, PathOracle& oracle);

  /// `moving`, on its way along `path` (>= 2 poses, joined by screw motions), past `fixed`. False: it does not pass, or
  /// the budget did not suffice for a proof.
  bool passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const;
  /// Distance along the unit vector `direction` after which the convex hulls of both groups are apart, at most `most`,
  /// where it is taken for granted; by that number of bisections.
  double distance_apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest,
                        const Eigen::Vector3d& direction, double most, int bisections) const;
  /// Corners of the convex hull of a part, in its assembled frame.
  const std::vector<Eigen::Vector3d>& hull(PartId part) const;
  std::size_t parts() const { return assembly_.parts.size(); }

 private:
  const std::vector<geometry::Solid>& solids(PartId part) const;
  std::vector<geometry::PlacedHull> hulls(const std::vector<PlacedPart>& parts) const;

  const Assembly& assembly_;
  double tolerance_;
  std::unique_ptr<PartMemo> own_;  // where the oracle shares none
  PartMemo& memo_;
  std::vector<Aabb> boxes_;  // by part
};

}  // namespace dismantle::blocking
