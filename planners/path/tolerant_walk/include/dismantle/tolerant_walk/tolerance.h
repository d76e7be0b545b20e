/// Where may the moving parts be, by what the judge tolerates?
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/simulator.h"
#include "dismantle/tolerant_walk/probes.h"
#include "dismantle/tolerant_walk/solid_field.h"

namespace dismantle::tolerant_walk {

/// A necessary condition, by samples: no pair penetrates deeper than when assembled and `max_penetration`. Made from
/// the original triangles, and by none of the judge's code. What it needs of a pair is computed when they first come
/// near each other. Not safe to use from several threads.
class Tolerance {
 public:
  /// `assembly` must outlive it.
  Tolerance(const Assembly& assembly, const Cast& cast, double max_penetration);

  /// `displacement` acts on all moving parts where the cast has them.
  bool allows(const Pose& displacement);
  /// The still part that forbade a displacement last.
  std::optional<PartId> in_way() const { return in_way_; }
  /// Distances that all answers so far have taken: what they cost, in a number that is the same everywhere.
  std::uint64_t asked() const { return asked_; }
  /// A place where the judge found it too permissive: `point` (assembled frame of `part`) lay too deep in `other` at
  /// that displacement. From now on neither it nor what is near it may be as deep, unless it is at the start.
  void learn(PartId part, PartId other, const Eigen::Vector3d& point, const Pose& displacement);

 private:
  struct Pair {
    Probes of_moving, of_still;
  };
  SolidField& field(PartId part);
  Pair& pair(const PlacedPart& moving, const PlacedPart& still);
  Allowance allowed(PartId a, PartId b) const;
  void learn(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point, const Pose& place,
             Probes& probes);
  bool clear(const PlacedPart& moving, const Pose& at, const PlacedPart& still);

  const Assembly& assembly_;
  Cast cast_;
  double max_penetration_;
  /// A moving part, for the question whether it may be near another at all.
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };
  std::vector<Ball> balls_;  // by moving part
  std::vector<Aabb> boxes_;  // by still part, its assembled frame
  std::map<PartId, std::unique_ptr<SolidField>> fields_;
  std::map<std::pair<PartId, PartId>, Pair> pairs_;  // moving, still
  std::optional<PartId> in_way_;
  std::uint64_t asked_ = 0;
  std::size_t first_ = 0;  // the still part that is asked first: the one that was in the way last
};

}  // namespace dismantle::tolerant_walk
