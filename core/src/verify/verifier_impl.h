/// What a Verifier keeps of the parts; shared by its judging and its proofs.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/verify/verifier.h"
#include "verify/bar_middle.h"
#include "verify/hulls_apart.h"
#include "verify/shut_in.h"
#include "verify/solid.h"

namespace dismantle {

struct Verifier::Impl {
  struct Body {
    std::vector<verify::Solid> solids;
    Aabb box;
    std::vector<Eigen::Vector3d> corners;  // of the convex hull
  };
  /// One column of the question: a part and its poses, one or as many as there are instants.
  struct Actor {
    PartId part = 0;
    std::vector<Pose> poses;
    Aabb swept;  // world
  };

  Impl(const Assembly& assembly, VerifyOptions options, unsigned threads);

  /// The pair's when assembled.
  double overlap(PartId a, PartId b) const;
  std::optional<Lock> locking_point(const InitialOverlap& overlap) const;
  verify::Ball ball_of(PartId part) const;
  std::optional<Enclosure> shut_in(const std::vector<PlacedPart>& inner, const std::vector<PlacedPart>& outer) const;
  verify::HullsApart hulls_of(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;

  const std::vector<std::vector<verify::InnerBall>>& middles_of(PartId part, const RunContext& context) const;
  std::optional<Cage> caged(PartId a, PartId b, const RunContext& context) const;
  using Pairs = std::vector<std::pair<const Actor*, const Actor*>>;
  void check(const Pairs& pairs, const RunContext& context, MotionCheck& result) const;
  bool near(const Actor& a, const Actor& b) const;
  bool check(const Actor& a, const Actor& b, const RunContext& context, std::size_t& rung, MotionCheck& result) const;
  bool check(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y, double allowed,
             const RunContext& context, std::size_t& rung, MotionCheck& result) const;

  std::vector<InitialOverlap> assembly_overlaps;
  VerifyOptions options;
  std::vector<double> rungs;
  std::vector<Lock> locks;
  std::vector<Body> bodies;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  mutable std::mutex cages_guard, middles_guard;
  mutable std::map<std::pair<PartId, PartId>, std::optional<Cage>> cages;  // of pairs that were asked for
  mutable std::vector<std::optional<std::vector<std::vector<verify::InnerBall>>>> middles;  // by part, by solid
  mutable std::mutex balls_guard;
  mutable std::vector<std::optional<verify::Ball>> balls;  // by part, found when first asked for
};

}  // namespace dismantle
