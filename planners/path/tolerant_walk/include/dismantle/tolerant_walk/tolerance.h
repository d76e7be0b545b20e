/// Where may the moving parts be, by what the verifier tolerates?
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

/// Where a pair may be as deep in each other as when assembled. What is thinner than that passes through walls where it
/// is allowed everywhere; and without it what is held with interference all the way never comes out.
enum class Overlap { everywhere, near_start };

/// A necessary condition, by samples: no pair penetrates deeper than when assembled and `max_penetration`. Made from
/// the original triangles, and by none of the verifier's code. What it needs of a pair is computed when they first come
/// near each other. Not safe to use from several threads.
class Tolerance {
 public:
  /// `assembly` and `cache` must outlive it.
  Tolerance(const Assembly& assembly, const Scene& scene, double max_penetration, Overlap overlap,
            GeometryCache& cache);

  /// `displacement` acts on all moving parts where the scene has them.
  bool allows(const Pose& displacement);
  /// The fixed part that forbade a displacement last.
  std::optional<PartId> in_way() const { return in_way_; }
  /// Distances that all answers so far have taken: what they cost, in a number that is the same everywhere.
  std::uint64_t asked() const { return asked_; }
  /// A place where the verifier found it too permissive: `point` (assembled frame of `part`) lay too deep in `other` at
  /// that displacement. From now on neither it nor what is near it may be as deep, unless it is at the start. True:
  /// nor may the rest of the two, for it was not the first such place; what was allowed may be so no more.
  bool learn(PartId part, PartId other, const Eigen::Vector3d& point, const Pose& displacement);

 private:
  struct Pair {
    Probes of_moving, of_fixed;
    Allowance deep;        ///< of these
    bool strict = false;   ///< what is deeper at the start is excused near there only
    unsigned refused = 0;  ///< by the verifier
  };
  SolidField& field(PartId part);
  Pair& pair(const PlacedPart& moving, const PlacedPart& fixed);
  Pair probes(const PlacedPart& moving, const PlacedPart& fixed, const Allowance& deep, bool strict);
  Allowance allowed(PartId a, PartId b) const;
  bool tighten(const PlacedPart& moving, const PlacedPart& fixed, Pair& both);
  void learn(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point, const Pose& place,
             const Pair& both, Probes& probes);
  bool clear(const PlacedPart& moving, const Pose& at, const PlacedPart& fixed);

  const Assembly& assembly_;
  Scene scene_;
  double max_penetration_;
  Overlap overlap_;
  /// A moving part, for the question whether it may be near another at all.
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };
  std::vector<Ball> balls_;  // by moving part
  std::vector<Aabb> boxes_;  // by fixed part, its assembled frame
  GeometryCache& cache_;
  std::map<PartId, std::shared_ptr<SolidField>> fields_;
  std::map<std::pair<PartId, PartId>, Pair> pairs_;  // moving, still
  std::optional<PartId> in_way_;
  std::uint64_t asked_ = 0;
  std::size_t first_ = 0;  // the fixed part that is asked first: the one that was in the way last
};

}  // namespace dismantle::tolerant_walk
