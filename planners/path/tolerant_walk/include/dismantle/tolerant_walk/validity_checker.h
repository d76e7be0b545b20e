/// State validity: does a pose penetrate no deeper than the verifier allows?
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/simulator.h"
#include "dismantle/tolerant_walk/geometry_cache.h"

namespace dismantle::tolerant_walk {

/// Checks a necessary condition at samples: no pair penetrates deeper than its initial overlap plus `max_penetration`.
/// Uses the original triangles and shares no code with the verifier. The probes of a pair are made when its parts first
/// come near each other. Not thread-safe.
class ValidityChecker {
 public:
  /// `assembly` and `cache` must outlive this object.
  ValidityChecker(const Assembly& assembly, const Scene& scene, double max_penetration, GeometryCache& cache,
                  const Sampling& sampling = {});

  /// `displacement` acts on all moving parts at their poses in the scene.
  bool is_valid(const Pose& displacement);
  /// The fixed part that made the last invalid displacement invalid.
  std::optional<PartId> obstacle() const { return obstacle_; }
  /// Adds a place that the verifier has refused: `point` (assembled frame of `part`) was too deep in `other` at
  /// `displacement`. From now on this point and its neighbours must stay less deep, except at the start.
  void add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point, const Pose& displacement);

 private:
  struct Pair {
    Probes of_moving, of_fixed;
  };
  DistanceField& field(PartId part);
  Pair& pair(const PlacedPart& moving, const PlacedPart& fixed);
  Allowance allowed(PartId a, PartId b) const;
  void add_probes(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point, const Pose& place,
                  Probes& probes);
  bool clear(const PlacedPart& moving, const Pose& at, const PlacedPart& fixed);

  const Assembly& assembly_;
  Scene scene_;
  double max_penetration_;
  /// Bounding ball of a moving part.
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };
  std::vector<Ball> balls_;  // by moving part
  std::vector<Aabb> boxes_;  // by fixed part, its assembled frame
  GeometryCache& cache_;
  Sampling sampling_;
  std::map<PartId, std::shared_ptr<DistanceField>> fields_;
  std::map<std::pair<PartId, PartId>, Pair> pairs_;  // by moving and fixed part
  std::optional<PartId> obstacle_;
  std::size_t first_ = 0;  // index of the fixed part to check first: the last obstacle
};

}  // namespace dismantle::tolerant_walk
