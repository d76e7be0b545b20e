#include "dismantle/tolerant_walk/validity_checker.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/hull.h"

namespace dismantle::tolerant_walk {

ValidityChecker::ValidityChecker(const Assembly& assembly, const Scene& scene, double max_penetration,
                                 GeometryCache& cache, const Sampling& sampling)
    : assembly_(assembly), scene_(scene), max_penetration_(max_penetration), cache_(cache), sampling_(sampling) {
  cache_.make_room();
  for (const auto& m : scene_.moving) {
    const Mesh& mesh = *assembly.parts[m.part].mesh;
    Ball ball{mesh.box().center(), 0};
    for (const auto& v : mesh.vertices) ball.radius = std::max(ball.radius, (v - ball.center).norm());
    balls_.push_back(ball);
  }
  for (const auto& s : scene_.fixed) boxes_.push_back(assembly.parts[s.part].mesh->box());
}

DistanceField& ValidityChecker::field(PartId part) {
  auto& known = fields_[part];
  if (!known) known = cache_.field(assembly_.parts[part].mesh, sampling_.resolution);
  return *known;
}

Allowance ValidityChecker::allowed(PartId a, PartId b) const {
  return {assembly_.initial_overlap(a, b), max_penetration_};
}

ValidityChecker::Pair& ValidityChecker::pair(const PlacedPart& moving, const PlacedPart& fixed) {
  const auto key = std::pair(moving.part, fixed.part);
  if (const auto known = pairs_.find(key); known != pairs_.end()) return known->second;
  const Allowance allowance = allowed(moving.part, fixed.part);
  const double near_distance = sampling_.resolution.near();
  const auto make = [&](const PlacedPart& of, const PlacedPart& other, const Pose& to_part) {
    // Samples are dense near the other part at its pose, and sparse elsewhere.
    Aabb near;
    for (const auto& v : hull_corners(assembly_.parts[other.part].mesh->vertices)) near.extend(to_part * v);
    near.inflate(near_distance);
    DistanceField& to_other = field(other.part);
    const Pose place = to_part.inverse();
    Probes all(field(of.part), allowance, near, sampling_.max_samples,
               [&](const Eigen::Vector3d& p) { return to_other.at(place * p) < near_distance; });
    all.merge(*cache_.probes({field(of.part).mesh(), sampling_, allowance}, [&] {
      return Probes(field(of.part), allowance, field(of.part).box(), sampling_.max_samples / 5,
                    [](const Eigen::Vector3d&) { return true; });
    }));
    return all;
  };
  const auto made = [&](const PlacedPart& of, const PlacedPart& other) {
    const Pose to_part = of.pose.inverse() * other.pose;
    const GeometryCache::Pair question(field(of.part).mesh(), field(other.part).mesh(), to_part, sampling_, allowance);
    return *cache_.probes(question, [&] { return make(of, other, to_part); });
  };
  return pairs_.emplace(key, Pair{made(moving, fixed), made(fixed, moving)}).first->second;
}

bool ValidityChecker::clear(const PlacedPart& moving, const Pose& at, const PlacedPart& fixed) {
  Pair& both = pair(moving, fixed);
  const Pose place = fixed.pose.inverse() * at;
  return !both.of_moving.any_violated(place, field(fixed.part)) &&
         !both.of_fixed.any_violated(place.inverse(), field(moving.part));
}

bool ValidityChecker::is_valid(const Pose& displacement) {
  for (std::size_t i = 0; i < scene_.moving.size(); ++i) {
    const PlacedPart& moving = scene_.moving[i];
    const Pose at = displacement * moving.pose;
    for (std::size_t k = 0; k < scene_.fixed.size(); ++k) {
      const std::size_t s = k == 0 ? first_ : k <= first_ ? k - 1 : k;
      const PlacedPart& fixed = scene_.fixed[s];
      // Parts that never come near each other need neither fields nor probes.
      const Eigen::Vector3d center = fixed.pose.inverse() * (at * balls_[i].center);
      if (boxes_[s].squared_distance(center) > balls_[i].radius * balls_[i].radius || clear(moving, at, fixed))
        continue;
      obstacle_ = fixed.part;
      first_ = s;
      return false;
    }
  }
  return true;
}

/// `place` maps the frame of `of` to that of `other`.
void ValidityChecker::add_probes(const PlacedPart& of, const PlacedPart& other, const Eigen::Vector3d& point,
                                 const Pose& place, Probes& probes) {
  const Allowance most = allowed(of.part, other.part);
  DistanceField& solid = field(other.part);
  // The verifier may refuse depths below the tolerance where a wall is thin or its bounds are not tight. From now on
  // half of the refused depth is allowed here, or half of the tolerance if the depth is unknown.
  const Eigen::Vector3d there = place * point;
  const double beyond = solid.at(there) < 0 ? solid.bvh().closest(there).distance - most.overlap : 0;
  const double keep = -most.overlap - 0.5 * (beyond > 0 ? std::min(beyond, most.tolerance) : most.tolerance);
  const Pose at_first = other.pose.inverse() * of.pose;
  const auto add = [&](const Eigen::Vector3d& p) { probes.add({p, std::min(keep, solid.at(at_first * p))}); };
  add(point);
  // The verifier would refuse nearby points next. At most about 100 vertices are added, however fine the mesh is.
  std::vector<Eigen::Vector3d> near;
  for (const auto& v : assembly_.parts[of.part].mesh->vertices)
    if ((v - point).norm() < sampling_.resolution.neighborhood()) near.push_back(v);
  const std::size_t every = near.size() / 100 + 1;
  for (std::size_t k = 0; k < near.size(); k += every) add(near[k]);
}

void ValidityChecker::add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point,
                                         const Pose& displacement) {
  for (const auto& moving : scene_.moving)
    for (const auto& fixed : scene_.fixed) {
      const Pose place = fixed.pose.inverse() * (displacement * moving.pose);
      if (std::minmax(moving.part, fixed.part) != std::minmax(part, other)) continue;
      Pair& both = pair(moving, fixed);
      if (moving.part == part)
        add_probes(moving, fixed, point, place, both.of_moving);
      else
        add_probes(fixed, moving, point, place.inverse(), both.of_fixed);
    }
}

}  // namespace dismantle::tolerant_walk
