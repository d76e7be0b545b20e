#include "dismantle/tolerant_walk/tolerance.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/hull.h"

namespace dismantle::tolerant_walk {
namespace {

constexpr double kCell = 0.01;            // assembly units: of the fields
constexpr double kNear = 0.06;            // assembly units: where the parts are so near each other when assembled ...
constexpr double kSpacing = 0.03;         // ... their samples are so far apart,
constexpr std::size_t kSamples = 5'000;   // or so that there are no more of each part around the other,
constexpr std::size_t kElsewhere = 1000;  // and so many all over
constexpr double kLearned = 0.5;          // share of max_penetration at a place that the judge has named

}  // namespace

Tolerance::Tolerance(const Assembly& assembly, const Cast& cast, double max_penetration)
    : assembly_(assembly), cast_(cast), max_penetration_(max_penetration) {
  for (const auto& m : cast_.moving) {
    const Mesh& mesh = *assembly.parts[m.part].mesh;
    Ball ball{mesh.box().center(), 0};
    for (const auto& v : mesh.vertices) ball.radius = std::max(ball.radius, (v - ball.center).norm());
    balls_.push_back(ball);
  }
  for (const auto& s : cast_.still) boxes_.push_back(assembly.parts[s.part].mesh->box());
}

SolidField& Tolerance::field(PartId part) {
  auto& known = fields_[part];
  if (!known) known = std::make_unique<SolidField>(assembly_.parts[part].mesh, kCell);
  return *known;
}

Allowance Tolerance::allowed(PartId a, PartId b) const { return {assembly_.initial_overlap(a, b), max_penetration_}; }

Tolerance::Pair& Tolerance::pair(const PlacedPart& moving, const PlacedPart& still) {
  const auto key = std::pair(moving.part, still.part);
  if (const auto known = pairs_.find(key); known != pairs_.end()) return known->second;
  const Allowance deep = allowed(moving.part, still.part);
  const auto probes = [&](const PlacedPart& of, const PlacedPart& other) {
    // Where the other stands, as seen from this one; dense there, sparse all over.
    const Pose to_part = of.pose.inverse() * other.pose;
    Aabb near;
    for (const auto& v : hull_corners(assembly_.parts[other.part].mesh->vertices)) near.extend(to_part * v);
    near.inflate(kNear);
    SolidField& to_other = field(other.part);
    const Pose place = to_part.inverse();
    Probes all(field(of.part), deep, near, kSamples, kSpacing,
               [&](const Eigen::Vector3d& p) { return to_other.at(place * p) < kNear; });
    all.take(Probes(field(of.part), deep, field(of.part).box(), kElsewhere, kSpacing,
                    [](const Eigen::Vector3d&) { return true; }));
    return all;
  };
  return pairs_.emplace(key, Pair{probes(moving, still), probes(still, moving)}).first->second;
}

bool Tolerance::clear(const PlacedPart& moving, const Pose& at, const PlacedPart& still) {
  Pair& both = pair(moving, still);
  const Pose place = still.pose.inverse() * at;
  return !both.of_moving.any_violated(place, field(still.part)) &&
         !both.of_still.any_violated(place.inverse(), field(moving.part));
}

bool Tolerance::allows(const Pose& displacement) {
  for (std::size_t i = 0; i < cast_.moving.size(); ++i) {
    const PlacedPart& moving = cast_.moving[i];
    const Pose at = displacement * moving.pose;
    for (std::size_t k = 0; k < cast_.still.size(); ++k) {
      const std::size_t s = k == 0 ? first_ : k <= first_ ? k - 1 : k;
      const PlacedPart& still = cast_.still[s];
      // Fields and probes of what never comes near are never made.
      const Eigen::Vector3d center = still.pose.inverse() * (at * balls_[i].center);
      if (boxes_[s].squared_distance(center) > balls_[i].radius * balls_[i].radius || clear(moving, at, still))
        continue;
      in_way_ = still.part;
      first_ = s;
      return false;
    }
  }
  return true;
}

void Tolerance::learn(PartId part, PartId other, const Eigen::Vector3d& point) {
  // Where the judge refuses less than that, it is because the wall is thin, or because it could not prove more.
  const Probe probe{point, -allowed(part, other).overlap - kLearned * max_penetration_};
  for (const auto& moving : cast_.moving)
    for (const auto& still : cast_.still) {
      if (moving.part == part && still.part == other) pair(moving, still).of_moving.add(probe);
      if (moving.part == other && still.part == part) pair(moving, still).of_still.add(probe);
    }
}

}  // namespace dismantle::tolerant_walk
