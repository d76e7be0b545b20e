/// Sample points of one part whose distances from another part tell whether the two penetrate too deeply.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/pose.h"
#include "dismantle/tolerant_walk/distance_field.h"

namespace dismantle::tolerant_walk {

/// A point (assembled frame of its part) whose signed distance from the other part may not be less than `keep`.
struct Probe {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double keep = 0;  ///< assembly units; negative for points of the surface, which may penetrate
  /// Within `reach` of `at` (frame of the other part) it may be as deep as it is there.
  struct Start {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double keep = 0, reach = 0;
  };
  std::uint32_t start = geometry::kNoIndex;  ///< in the list of Probes
};

/// Penetration that is allowed to a pair, in assembly units: its initial overlap and a tolerance on top. Where a wall
/// is thin, the tolerance is a quarter of its thickness at most: the verifier's rule.
struct Allowance {
  double overlap = 0, tolerance = 0;
  bool exact = false;  ///< distances are measured where fields might be wrong, and acute edges count as thin: slower
};

/// There are two kinds. Points of the edges may be as deep in the other part as is allowed. The centre of a medial ball
/// (the largest ball within the part that touches its surface at one point) keeps the other part's surface away by its
/// radius less the allowance: such probes detect thin walls that lie between the points of the other part.
class Probes {
 public:
  /// Samples the surface of `part` within `region` where `wanted` returns true. Samples are
  /// Resolution::sample_spacing() apart, or further, so that about `max_count` of them cover the surface in the region.
  Probes(DistanceField& part, const Allowance& allowance, const Aabb& region, std::size_t max_count,
         const std::function<bool(const Eigen::Vector3d&)>& wanted);

  /// Is one of them nearer to the other part than it may be? `place` maps the part's frame to that of the other.
  /// `distance_queries` is increased by the number of queries that this took.
  bool any_violated(const Pose& place, DistanceField& other, std::uint64_t& distance_queries);
  /// Adds the probes of another set of the same part.
  void merge(Probes other);
  void add(const Probe& probe) { added_.push_back(probe); }
  /// Copies what was added to another set of the same part by add().
  void copy_added(const Probes& other);
  /// Probes that are too deep at `place` may be as deep within `reach` of there.
  void allow_near(const Pose& place, DistanceField& other, double reach);
  std::size_t size() const { return probes_.size() + added_.size(); }
  std::size_t bytes() const;  ///< approximate memory

 private:
  struct Node {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 0, keep = 0;
    std::uint32_t first = 0,
                  count = 0;  ///< inner nodes have count 0; their left child is the next node, `first` is the right one
  };
  void build(std::uint32_t first, std::uint32_t count);

  bool exact_ = false;
  std::vector<Probe> probes_, added_;
  std::vector<Probe::Start> starts_;
  std::vector<Node> nodes_;
  std::uint32_t last_ = 0;  // the probe that was violated last
};

}  // namespace dismantle::tolerant_walk
