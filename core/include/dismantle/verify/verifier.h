/// The judge: checks plans on the original triangles, sharing nothing with any simulator (DESIGN section 7).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/model/assembly.h"
#include "dismantle/path_planner.h"

namespace dismantle {

struct VerifyOptions {
  double max_penetration = 0.01;  ///< assembly units, > 0; above the pair's initial overlap
};

/// Where a check failed.
struct Violation {
  PartId part = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of `part`, its assembled frame
  double depth = 0;       ///< measured depth at `point` in `other`; at least allowed + max_penetration unless `uncertain`
  double allowed = 0;     ///< initial overlap of the pair
  std::size_t segment = 0;  ///< path segment (between instants segment and segment + 1)
  double u = 0;             ///< place in the segment, [0, 1]
  bool uncertain = false;   ///< could not be certified at the resolution limit, but no point beyond was found
};

struct MotionCheck {
  bool valid = false;
  double max_penetration = 0;  ///< valid: certified upper bound above the initial overlap (a rung of a fixed ladder)
  std::optional<Violation> violation;
  std::uint64_t tests = 0;     ///< elementary sweep tests done
};

/// Built once per assembly; const functions are safe to call from several threads.
class DISMANTLE_API Verifier {
 public:
  Verifier(const Assembly& assembly, VerifyOptions options);
  ~Verifier();

  /// (b): the moving parts follow `path` (columns as `moving`) past `still`. Pairs that do not move
  /// relative to each other are not looked at.
  MotionCheck check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& still,
                           const Path& path) const;
  /// (c): the hull of `group` is apart from the hull of `rest`, on all original vertices.
  bool apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;
  const VerifyOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Depth in assembly units to which the surfaces of the two meshes penetrate each other: the largest
/// distance from a surface point of one, inside the other, to the other's surface, both ways.
/// Exact to `tolerance` (> 0) from below; 0 when they only touch. Poses place the meshes.
DISMANTLE_API double penetration_depth(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                       double tolerance);

}  // namespace dismantle
