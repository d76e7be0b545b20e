#include "dismantle/tolerant_walk/tolerance.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/hull.h"

namespace dismantle::tolerant_walk {
namespace {

constexpr double kNear = 0.06;            // assembly units: where the parts are so near each other when assembled ...
constexpr double kSpacing = 0.03;         // ... their samples are so far apart,
constexpr std::size_t kSamples = 5'000;   // or so that there are no more of each part around the other,
constexpr std::size_t kElsewhere = 1000;  // and so many all over
constexpr double kReach = 3, kLeastReach = 0.02;  // an overlap is excused so near the start: overlaps; assembly units
constexpr double kOverlapShare = 0.125;           // of what is allowed beyond; less overlap is within it
constexpr double kLeastShare = 0.0625;            // of what is allowed beyond: not less is aimed at
constexpr double kLearned = 0.5;                  // share of what was too deep at a place that the judge has named
constexpr double kBeside = 0.05;                  // assembly units: what is so near such a place ...
constexpr std::size_t kMostBeside = 100;          // ... counts as well, so many corners of triangles of it

double reach_of_overlap(double overlap) { return kLeastReach + kReach * overlap; }

}  // namespace

Tolerance::Tolerance(const Assembly& assembly, const Cast& cast, double max_penetration, Overlap overlap,
                     GeometryCache& cache)
    : assembly_(assembly), cast_(cast), max_penetration_(max_penetration), overlap_(overlap), cache_(cache) {
  cache_.make_room();
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
  if (!known) known = cache_.field(assembly_.parts[part].mesh);
  return *known;
}

Allowance Tolerance::allowed(PartId a, PartId b) const {
  return {assembly_.initial_overlap(a, b), max_penetration_, overlap_ == Overlap::near_start};
}

Tolerance::Pair& Tolerance::pair(const PlacedPart& moving, const PlacedPart& still) {
  const auto key = std::pair(moving.part, still.part);
  if (const auto known = pairs_.find(key); known != pairs_.end()) return known->second;
  Allowance deep = allowed(moving.part, still.part);
  const bool strict = overlap_ == Overlap::near_start && deep.overlap > kOverlapShare * max_penetration_;
  if (strict) deep = {0, deep.beyond, true};
  return pairs_.emplace(key, probes(moving, still, deep, strict)).first->second;
}

/// `strict`: what is deeper at the start is excused near there.
Tolerance::Pair Tolerance::probes(const PlacedPart& moving, const PlacedPart& still, const Allowance& deep,
                                  bool strict) {
  const double reach = strict ? reach_of_overlap(allowed(moving.part, still.part).overlap) : 0;
  const auto make = [&](const PlacedPart& of, const PlacedPart& other, const Pose& to_part) {
    // Where the other stands, as seen from this one; dense there, sparse all over.
    Aabb near;
    for (const auto& v : hull_corners(assembly_.parts[other.part].mesh->vertices)) near.extend(to_part * v);
    near.inflate(kNear);
    SolidField& to_other = field(other.part);
    const Pose place = to_part.inverse();
    Probes all(field(of.part), deep, near, kSamples, kSpacing,
               [&](const Eigen::Vector3d& p) { return to_other.at(place * p) < kNear; });
    all.take(*cache_.probes({field(of.part).mesh(), deep}, [&] {
      return Probes(field(of.part), deep, field(of.part).box(), kElsewhere, kSpacing,
                    [](const Eigen::Vector3d&) { return true; });
    }));
    if (strict) all.excuse(place, to_other, reach);
    return all;
  };
  const auto made = [&](const PlacedPart& of, const PlacedPart& other) {
    const Pose to_part = of.pose.inverse() * other.pose;
    const GeometryCache::Pair key(field(of.part).mesh(), field(other.part).mesh(), to_part, deep, reach);
    return *cache_.probes(key, [&] { return make(of, other, to_part); });
  };
  return {made(moving, still), made(still, moving), deep, strict, 0};
}

/// Where the judge sees deeper than samples do again, less is aimed at.
bool Tolerance::tighten(const PlacedPart& moving, const PlacedPart& still, Pair& both) {
  if (overlap_ == Overlap::everywhere || both.refused < 2 || both.deep.beyond < kLeastShare * max_penetration_)
    return false;
  Allowance deep = both.deep;
  deep.beyond *= kLearned;
  Pair next = probes(moving, still, deep, true);
  next.refused = both.refused;
  next.of_moving.learn_from(both.of_moving);
  next.of_still.learn_from(both.of_still);
  both = std::move(next);
  return true;
}

bool Tolerance::clear(const PlacedPart& moving, const Pose& at, const PlacedPart& still) {
  Pair& both = pair(moving, still);
  const Pose place = still.pose.inverse() * at;
  return !both.of_moving.any_violated(place, field(still.part), asked_) &&
         !both.of_still.any_violated(place.inverse(), field(moving.part), asked_);
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

/// `place` takes the frame of the one to that of the other.
void Tolerance::learn(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point, const Pose& place,
                      const Pair& both, Probes& probes) {
  const Allowance& most = both.deep;
  const double reach = reach_of_overlap(allowed(of.part, other.part).overlap);
  SolidField& solid = field(other.part);
  // Where the judge refuses less than it tolerates elsewhere, it is because the wall is thin, or because it could not
  // prove more. Half of what it refused, or else half of what it tolerates.
  const Eigen::Vector3d there = place * point;
  const double beyond = solid.at(there) < 0 ? solid.bvh().closest(there).distance - most.overlap : 0;
  const double keep = -most.overlap - kLearned * (beyond > 0 ? std::min(beyond, most.beyond) : most.beyond);
  const Pose at_first = other.pose.inverse() * of.pose;
  const auto add = [&](const Eigen::Vector3d& p) {
    probes.add({p, both.strict ? keep : std::min(keep, solid.at(at_first * p))});
  };
  add(point);
  // What is as thin beside it would be refused next.
  std::vector<Eigen::Vector3d> near;
  for (const auto& v : assembly_.parts[of.part].mesh->vertices)
    if ((v - point).squaredNorm() < kBeside * kBeside) near.push_back(v);
  const std::size_t every = near.size() / kMostBeside + 1;
  for (std::size_t k = 0; k < near.size(); k += every) add(near[k]);
  if (both.strict) probes.excuse(at_first, solid, reach);
}

bool Tolerance::learn(PartId part, PartId other, const Eigen::Vector3d& point, const Pose& displacement) {
  bool tightened = false;
  for (const auto& moving : cast_.moving)
    for (const auto& still : cast_.still) {
      const Pose place = still.pose.inverse() * (displacement * moving.pose);
      if (std::minmax(moving.part, still.part) != std::minmax(part, other)) continue;
      Pair& both = pair(moving, still);
      ++both.refused;
      tightened = tighten(moving, still, both) || tightened;
      if (moving.part == part)
        learn(moving, still, point, place, both, both.of_moving);
      else
        learn(still, moving, point, place.inverse(), both, both.of_still);
    }
  return tightened;
}

}  // namespace dismantle::tolerant_walk
