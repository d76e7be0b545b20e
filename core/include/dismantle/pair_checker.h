/// Facts about two parts, or two groups, whatever other parts there are.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// What a sequence planner may ask of the verifier about pairs, to order its work. Its answers are no plan: a path that is
/// found with them is verified as a whole (PathOracle::propose). May be called from several threads.
class DISMANTLE_API PairChecker {
 public:
  virtual ~PairChecker();
  virtual std::size_t parts() const = 0;
  /// Corners of the convex hull of a part, in its assembled frame; assembly units.
  virtual const std::vector<Eigen::Vector3d>& hull(PartId part) const = 0;
  /// Does `moving` pass `fixed`, which is at `fixed_at`, along these poses? True is proved; false means that it does not, or
  /// that a small effort did not prove it.
  virtual bool passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const = 0;
  /// Distance along the unit vector `direction`, at most `most` (taken for granted), after which the convex hull of `group`
  /// is disjoint from that of `rest`; found by halving the interval that many times. Assembly units.
  virtual double separation_distance(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest,
                                     const Eigen::Vector3d& direction, double most, int halvings) const = 0;
};

}  // namespace dismantle
