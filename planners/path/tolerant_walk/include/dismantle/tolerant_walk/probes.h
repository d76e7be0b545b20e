/// Points of one part that tell by their distance from another whether the two penetrate too deep.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"
#include "dismantle/tolerant_walk/solid_field.h"

namespace dismantle::tolerant_walk {

/// A point (assembled frame of its part) whose signed distance from the other part may not be less than `keep`.
struct Probe {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double keep = 0;  ///< assembly units; negative for points of the surface, which may be so deep
  /// Close to this place, in the other part's frame, it may be as deep as it is there.
  struct Start {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double keep = 0, reach = 0;
  };
  std::uint32_t start = kNoStart;  ///< in the list of Probes
  static constexpr std::uint32_t kNoStart = 0xffffffffu;
};

/// How deep a pair may penetrate (assembly units): as when assembled, and beyond that so much, but no more than a
/// quarter of the wall's thickness where that is thin.
struct Allowance {
  double overlap = 0, beyond = 0;
  bool exactly = false;  ///< costs more: distances are measured where fields might be wrong, acute edges count as thin
};

/// Two kinds. Points of the edges may be as deep in the other part as is allowed. And the centre of a ball within
/// the part, touching its surface and as large as can be (its medial axis), keeps the other's surface away by the
/// ball's radius less what is allowed: so thin walls are seen, that lie between the points of the other.
class Probes {
 public:
  /// Samples of `part` within `region`, where they are `wanted`: `least_spacing` apart, or as if about `most` were to
  /// be spread over its surface there.
  Probes(SolidField& part, const Allowance& allowance, const Aabb& region, std::size_t most, double least_spacing,
         const std::function<bool(const Eigen::Vector3d&)>& wanted);

  /// Is one of them where it may not be? `place` takes the part's frame to that of the other. `asked` grows by the
  /// number of distances that this took.
  bool any_violated(const Pose& place, SolidField& other, std::uint64_t& asked);
  /// Joins those of another set of the same part.
  void take(Probes other);
  void add(const Probe& probe) { added_.push_back(probe); }
  /// What was added to another set of the same part is added to this one.
  void learn_from(const Probes& other);
  /// Those that are too deep when at `place` may be a little deeper than that within `reach` of where they are there.
  void excuse(const Pose& place, SolidField& other, double reach);
  std::size_t size() const { return probes_.size() + added_.size(); }
  std::size_t bytes() const;  ///< about so much memory

 private:
  struct Node {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 0, keep = 0;
    std::uint32_t first = 0, count = 0;  ///< inner nodes: count 0, the left child is next, `first` is the right one
  };
  void build(std::uint32_t first, std::uint32_t count);

  bool exactly_ = false;
  std::vector<Probe> probes_, added_;
  std::vector<Probe::Start> starts_;
  std::vector<Node> nodes_;
  std::uint32_t last_ = 0;  // that was violated
};

}  // namespace dismantle::tolerant_walk
