/// What a Verifier keeps of the parts; shared by its judging and its proofs.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bar_middle.h"
#include "computed_once.h"
#include "dismantle/verification/verifier.h"
#include "hulls_apart.h"
#include "shut_in.h"
#include "solid.h"

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

  Impl(const Assembly& assembly, VerifyOptions options, Executor* executor);

  /// The pair's when assembled.
  double overlap(PartId a, PartId b) const;
  std::optional<Lock> locking_point(const InitialOverlap& overlap) const;
  verify::Ball ball_of(PartId part) const;
  std::optional<Enclosure> shut_in(const std::vector<PlacedPart>& inner, const std::vector<PlacedPart>& outer) const;
  verify::HullsApart hulls_of(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const;

  using Middles = std::vector<std::vector<verify::InnerBall>>;  // by solid
  /// Null when told to stop.
  const Middles* middles_of(PartId part, const RunContext& context) const;
  std::optional<Cage> caged(PartId a, PartId b, const RunContext& context) const;
  using Pairs = std::vector<std::pair<const Actor*, const Actor*>>;
  /// What was seen of a pair.
  struct Look {
    bool done = false, passed = false;
    std::size_t from = 0, rung = 0;  // first and last that was tried
    MotionCheck found;
  };
  Look look_at(const Pairs::value_type& pair, std::size_t rung, const RunContext& context) const;
  std::vector<Look> looks_ahead(const Pairs& pairs, const RunContext& context) const;
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
  mutable std::mutex cages_guard;
  mutable std::map<std::pair<PartId, PartId>, std::optional<Cage>> cages;  // of pairs that were asked for
  mutable std::deque<verify::ComputedOnce<Middles>> middles;               // by part
  mutable std::deque<verify::ComputedOnce<verify::Ball>> balls;            // by part
};

}  // namespace dismantle
