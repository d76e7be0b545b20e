/// Sample points of one part whose distances from another part tell whether the two penetrate too deeply.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"
#include "dismantle/tolerant_walk/distance_field.h"

namespace dismantle::tolerant_walk {

/// A point (assembled frame of its part) whose signed distance from the other part may not be less than `keep`.
struct Probe {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double keep = 0;  ///< assembly units; negative for points of the surface, which may penetrate
};

/// Penetration that a pair may have, in assembly units: its initial overlap plus a tolerance. At thin walls the
/// tolerance is at most a quarter of the wall's thickness, as in the verifier.
struct Allowance {
  double overlap = 0, tolerance = 0;
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
  bool any_violated(const Pose& place, DistanceField& other);
  /// Adds the probes of another set of the same part.
  void merge(Probes other);
  void add(const Probe& probe) { added_.push_back(probe); }
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

  std::vector<Probe> probes_, added_;
  std::vector<Node> nodes_;
  std::uint32_t last_ = 0;  // the most recently violated probe
};

}  // namespace dismantle::tolerant_walk
