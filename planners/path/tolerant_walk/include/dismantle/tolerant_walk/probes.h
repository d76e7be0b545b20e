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
  /// Within `reach` of `at` (frame of the other part) the probe may be as deep as it is at `at`.
  struct Start {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double keep = 0, reach = 0;
  };
  std::uint32_t start = geometry::kNoIndex;  ///< index into the starts of Probes
};

/// Penetration that a pair may have, in assembly units: its initial overlap plus a tolerance. At thin walls the
/// tolerance is at most a quarter of the wall's thickness, as in the verifier.
struct Allowance {
  double overlap = 0, tolerance = 0;
  bool exact = false;  ///< slower: measures distances where fields might be wrong, and treats acute edges as thin walls
};

/// There are two kinds. Points on edges may be as deep in the other part as the allowance. The centre of a medial ball
/// (the largest ball inside the part that touches its surface at a given point) must stay at least the ball's radius
/// minus the allowance outside the other part. These probes detect thin walls between the other part's points.
class Probes {
 public:
  /// Samples the surface of `part` within `region` where `wanted` returns true. Samples are at least
  /// Resolution::sample_spacing() apart, and so far apart that about `max_count` of them cover the surface in `region`.
  Probes(DistanceField& part, const Allowance& allowance, const Aabb& region, std::size_t max_count,
         const std::function<bool(const Eigen::Vector3d&)>& wanted);

  /// True if any probe is nearer to the other part than allowed. `place` maps the part's frame to that of the other.
  /// Adds the number of queries used to `distance_queries`.
  bool any_violated(const Pose& place, DistanceField& other, std::uint64_t& distance_queries);
  /// Adds the probes of another set of the same part.
  void merge(Probes other);
  void add(const Probe& probe) { added_.push_back(probe); }
  /// Copies the probes that add() has added to another set of the same part.
  void copy_added(const Probes& other);
  /// Probes that are too deep at `place` may be just as deep within `reach` of their positions there.
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
  std::uint32_t last_ = 0;  // the most recently violated probe
};

}  // namespace dismantle::tolerant_walk
