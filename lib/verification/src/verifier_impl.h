/// Internal data of a Verifier.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/geometry/directed_check.h"
#include "dismantle/geometry/hulls_apart.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/verification/verifier.h"
#include "geometry_names.h"
#include "pair_memory.h"

namespace dismantle {

struct Verifier::Impl {
  struct Body {
    std::vector<verify::Solid> solids;
    Aabb box;
    std::vector<Eigen::Vector3d> corners;  // of the convex hull
  };
  /// A part of the checked motion and its poses: one if it is fixed, else one per instant.
  struct Actor {
    PartId part = 0;
    std::vector<Pose> poses;
    geometry::SweptBoxes swept;  // world
    Actor(PartId id, std::vector<Pose> at, const Aabb& box) : part(id), poses(std::move(at)), swept(poses, box) {}
  };

  Impl(const Assembly& assembly, VerifyOptions options, const RunContext& context);

  /// Initial overlap of the pair.
  double overlap(PartId a, PartId b) const;
  const Aabb* region(PartId a, PartId b) const;
  verify::HullsApart hulls_of(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;
  /// Budget for a path of that many segments, for a rung that decides or for one that may fail.
  geometry::Budget budget_for(std::size_t segments, bool decides, bool overlapping, const RunContext* context) const;
  using Pairs = std::vector<std::pair<const Actor*, const Actor*>>;
  /// Result of the check of one pair.
  struct PairResult {
    bool done = false, passed = false;
    std::size_t from = 0, rung = 0;  // first and last rung tried
    MotionCheck found;
  };
  PairResult check_pair(const Pairs::value_type& pair, std::size_t rung, const RunContext& context) const;
  std::vector<PairResult> check_pairs(const Pairs& pairs, const RunContext& context) const;
  void check(const Pairs& pairs, const RunContext& context, MotionCheck& result) const;
  bool check(const Actor& a, const Actor& b, const RunContext& context, std::size_t& rung, MotionCheck& result) const;
  bool check(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y, double allowed,
             const RunContext& context, std::size_t& rung, MotionCheck& result) const;
  static Violation violation(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y,
                             const geometry::Finding& found, double allowed, std::size_t segments);
  bool check_elsewhere(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y,
                       const Aabb& region, const RunContext& context, MotionCheck& result) const;

  std::vector<InitialOverlap> assembly_overlaps;
  struct Region {
    PartId a = 0, b = 0;
    Aabb box;
  };
  std::vector<Region> regions;  // of pairs whose overlap is allowed only there (law 3)
  VerifyOptions options;
  std::vector<double> rungs;   // certified bounds, ascending to the tolerance
  std::size_t worthwhile = 0;  // rung that gets the whole budget although a wider one suffices
  std::vector<Body> bodies;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  mutable PairMemory<PairResult> known;
};

}  // namespace dismantle
