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
constexpr double kLearned = 0.5;                  // share of what was too deep at a place that the verifier has named
constexpr double kBeside = 0.05;                  // assembly units: what is so near such a place ...
constexpr std::size_t kMostBeside = 100;          // ... counts as well, so many corners of triangles of it

double reach_of_overlap(double overlap) { return kLeastReach + kReach * overlap; }

}  // namespace

Tolerance::Tolerance(const Assembly& assembly, const Scene& scene, double max_penetration, Overlap overlap,
                     GeometryCache& cache)
    : assembly_(assembly), scene_(scene), max_penetration_(max_penetration), overlap_(overlap), cache_(cache) {
  cache_.make_room();
  for (const auto& m : scene_.moving) {
    const Mesh& mesh = *assembly.parts[m.part].mesh;
    Ball ball{mesh.box().center(), 0};
    for (const auto& v : mesh.vertices) ball.radius = std::max(ball.radius, (v - ball.center).norm());
    balls_.push_back(ball);
  }
  for (const auto& s : scene_.fixed) boxes_.push_back(assembly.parts[s.part].mesh->box());
}

SolidField& Tolerance::field(PartId part) {
  auto& known = fields_[part];
  if (!known) known = cache_.field(assembly_.parts[part].mesh);
  return *known;
}

Allowance Tolerance::allowed(PartId a, PartId b) const {
  return {assembly_.initial_overlap(a, b), max_penetration_, overlap_ == Overlap::near_start};
}

Tolerance::Pair& Tolerance::pair(const PlacedPart& moving, const PlacedPart& fixed) {
  const auto key = std::pair(moving.part, fixed.part);
  if (const auto known = pairs_.find(key); known != pairs_.end()) return known->second;
  Allowance deep = allowed(moving.part, fixed.part);
  const bool strict = overlap_ == Overlap::near_start && deep.overlap > kOverlapShare * max_penetration_;
  if (strict) deep = {0, deep.beyond, true};
  return pairs_.emplace(key, probes(moving, fixed, deep, strict)).first->second;
}

/// `strict`: what is deeper at the start is excused near there.
Tolerance::Pair Tolerance::probes(const PlacedPart& moving, const PlacedPart& fixed, const Allowance& deep,
                                  bool strict) {
  const double reach = strict ? reach_of_overlap(allowed(moving.part, fixed.part).overlap) : 0;
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
  return {made(moving, fixed), made(fixed, moving), deep, strict, 0};
}

/// Where the verifier sees deeper than samples do again, less is aimed at.
bool Tolerance::tighten(const PlacedPart& moving, const PlacedPart& fixed, Pair& both) {
  if (overlap_ == Overlap::everywhere || both.refused < 2 || both.deep.beyond < kLeastShare * max_penetration_)
    return false;
  Allowance deep = both.deep;
  deep.beyond *= kLearned;
  Pair next = probes(moving, fixed, deep, true);
  next.refused = both.refused;
  next.of_moving.learn_from(both.of_moving);
  next.of_fixed.learn_from(both.of_fixed);
  both = std::move(next);
  return true;
}

bool Tolerance::clear(const PlacedPart& moving, const Pose& at, const PlacedPart& fixed) {
  Pair& both = pair(moving, fixed);
  const Pose place = fixed.pose.inverse() * at;
  return !both.of_moving.any_violated(place, field(fixed.part), asked_) &&
         !both.of_fixed.any_violated(place.inverse(), field(moving.part), asked_);
}

bool Tolerance::allows(const Pose& displacement) {
  for (std::size_t i = 0; i < scene_.moving.size(); ++i) {
    const PlacedPart& moving = scene_.moving[i];
    const Pose at = displacement * moving.pose;
    for (std::size_t k = 0; k < scene_.fixed.size(); ++k) {
      const std::size_t s = k == 0 ? first_ : k <= first_ ? k - 1 : k;
      const PlacedPart& fixed = scene_.fixed[s];
      // Fields and probes of what never comes near are never made.
      const Eigen::Vector3d center = fixed.pose.inverse() * (at * balls_[i].center);
      if (boxes_[s].squared_distance(center) > balls_[i].radius * balls_[i].radius || clear(moving, at, fixed))
        continue;
      in_way_ = fixed.part;
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
  // Where the verifier refuses less than it tolerates elsewhere, it is because the wall is thin, or because it could
  // not prove more. Half of what it refused, or else half of what it tolerates.
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
  for (const auto& moving : scene_.moving)
    for (const auto& fixed : scene_.fixed) {
      const Pose place = fixed.pose.inverse() * (displacement * moving.pose);
      if (std::minmax(moving.part, fixed.part) != std::minmax(part, other)) continue;
      Pair& both = pair(moving, fixed);
      ++both.refused;
      tightened = tighten(moving, fixed, both) || tightened;
      if (moving.part == part)
        learn(moving, fixed, point, place, both, both.of_moving);
      else
        learn(fixed, moving, point, place.inverse(), both, both.of_fixed);
    }
  return tightened;
}

}  // namespace dismantle::tolerant_walk
