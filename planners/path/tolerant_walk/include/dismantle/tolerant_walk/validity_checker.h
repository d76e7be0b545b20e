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

/// Where a pair may penetrate as deeply as when assembled. A part that is thinner than its overlap passes through walls
/// if that is everywhere; a part that is held with interference along its whole path never leaves if it is not.
enum class Overlap { everywhere, near_start };

/// A necessary condition, by samples: no pair penetrates deeper than its initial overlap plus `max_penetration`. It is
/// computed from the original triangles, and shares no code with the verifier. Probes of a pair are made when its parts
/// first come near each other. Not safe to use from several threads.
class ValidityChecker {
 public:
  /// `assembly` and `cache` must outlive it. `overlap_reach`: with Overlap::near_start, an overlap is allowed within
  /// this many times its depth.
  ValidityChecker(const Assembly& assembly, const Scene& scene, double max_penetration, Overlap overlap,
                  GeometryCache& cache, const Sampling& sampling = {}, double overlap_reach = 3);

  /// `displacement` acts on all moving parts at their poses in the scene.
  bool is_valid(const Pose& displacement);
  /// The fixed part because of which a displacement was invalid last.
  std::optional<PartId> obstacle() const { return obstacle_; }
  /// Number of distance queries until now: the cost in a unit that does not depend on the machine.
  std::uint64_t distance_queries() const { return distance_queries_; }
  /// Adds a place that the verifier has refused: `point` (assembled frame of `part`) was too deep in `other` at that
  /// displacement. From now on this point and those near it have to stay less deep, except at the start. True: the
  /// tolerance of the whole pair was halved as well, because it was refused before. Poses that were valid may then be
  /// invalid.
  bool add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point, const Pose& displacement);

 private:
  struct Pair {
    Probes of_moving, of_fixed;
    Allowance allowance;            ///< of these
    bool overlap_at_start = false;  ///< probes that are deeper at the start are allowed near there only
    unsigned refused = 0;           ///< number of refusals by the verifier
  };
  DistanceField& field(PartId part);
  Pair& pair(const PlacedPart& moving, const PlacedPart& fixed);
  Pair probes(const PlacedPart& moving, const PlacedPart& fixed, const Allowance& allowance, bool overlap_at_start);
  Allowance allowed(PartId a, PartId b) const;
  double reach_of_overlap(PartId a, PartId b) const;
  bool tighten(const PlacedPart& moving, const PlacedPart& fixed, Pair& both);
  void add_probes(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point, const Pose& place,
                  const Pair& both, Probes& probes);
  bool clear(const PlacedPart& moving, const Pose& at, const PlacedPart& fixed);

  const Assembly& assembly_;
  Scene scene_;
  double max_penetration_;
  Overlap overlap_;
  /// Bounding ball of a moving part.
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };
  std::vector<Ball> balls_;  // by moving part
  std::vector<Aabb> boxes_;  // by fixed part, its assembled frame
  GeometryCache& cache_;
  Sampling sampling_;
  double overlap_reach_;
  std::map<PartId, std::shared_ptr<DistanceField>> fields_;
  std::map<std::pair<PartId, PartId>, Pair> pairs_;  // moving, fixed
  std::optional<PartId> obstacle_;
  std::uint64_t distance_queries_ = 0;
  std::size_t first_ = 0;  // the fixed part that is checked first: the last obstacle
};

}  // namespace dismantle::tolerant_walk
