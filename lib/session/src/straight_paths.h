/// Straight paths that separate hulls.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/geometry/hulls_apart.h"

namespace dismantle {

/// Equal but for rounding.
bool same_place(const Pose& a, const Pose& b);

/// Of one assembly, which must outlive this.
class StraightPaths {
 public:
  explicit StraightPaths(const Assembly& assembly);
  /// As long as it takes to separate the hulls. `out`: unit.
  Path path(const std::vector<PlacedPart>& moving, const std::vector<PlacedPart>& rest, const Eigen::Vector3d& out);
  /// Lengthens a path that ends too early among these parts, if its last displacement is straight.
  Path long_enough(Path path, const std::vector<PartId>& moving, const std::vector<PlacedPart>& rest);

 private:
  void extend(Path& path, const std::vector<PartId>& moving, const std::vector<PlacedPart>& rest,
              const Eigen::Vector3d& out);
  std::vector<geometry::PlacedHull> hulls_of(const std::vector<PlacedPart>& parts);

  const Assembly& assembly_;
  std::vector<Aabb> boxes_;                            // by part
  std::vector<std::vector<Eigen::Vector3d>> corners_;  // by part, when they were needed
};

}  // namespace dismantle
