#include "straight_paths.h"

#include <utility>

#include "dismantle/geometry/hull.h"
#include "dismantle/part_set.h"

namespace dismantle {
namespace {

constexpr int kBisections = 20;       // of the length of a straight path
constexpr double kBeyond = 1e-3;      // of that length: hulls that are just apart are not proved apart
constexpr double kSamePlace = 1e-12;  // assembly units, and change of a unit quaternion
constexpr double kSameTurn = 1e-9;    // rad

}  // namespace

bool same_place(const Pose& a, const Pose& b) {
  return (a.t - b.t).norm() <= kSamePlace && (a.q.coeffs() - b.q.coeffs()).norm() <= kSamePlace;
}

StraightPaths::StraightPaths(const Assembly& assembly) : assembly_(assembly), corners_(assembly.parts.size()) {
  for (const Part& part : assembly.parts) boxes_.push_back(part.mesh->box());
}

Path StraightPaths::path(const std::vector<PlacedPart>& moving, const std::vector<PlacedPart>& rest,
                         const Eigen::Vector3d& out) {
  Path path(1);
  for (const PlacedPart& p : moving) path.front().push_back(p.pose);
  extend(path, ids_of(moving), rest, out);
  return path;
}

Path StraightPaths::long_enough(Path path, const std::vector<PartId>& moving, const std::vector<PlacedPart>& rest) {
  const auto at = [&](std::size_t k) -> const Pose& { return path[k].front(); };
  std::size_t from = path.size() - 1;
  while (from > 0 && same_place(at(from - 1), at(path.size() - 1))) --from;
  if (from == 0) return path;
  const Eigen::Vector3d last = at(from).t - at(from - 1).t;
  const bool translates = at(from).q.angularDistance(at(from - 1).q) < kSameTurn && last.norm() > kSamePlace;
  if (translates) extend(path, moving, rest, last.normalized());
  return path;
}

/// Adds a translation after which the hulls are apart, if they are not yet.
void StraightPaths::extend(Path& path, const std::vector<PartId>& moving, const std::vector<PlacedPart>& rest,
                           const Eigen::Vector3d& out) {
  std::vector<PlacedPart> at_end;
  for (std::size_t i = 0; i < moving.size(); ++i) at_end.push_back({moving[i], path.back()[i]});
  geometry::HullsApart hulls(hulls_of(at_end), hulls_of(rest));
  if (path.size() > 1 && hulls.after(Eigen::Vector3d::Zero())) return;
  Aabb all;
  for (const std::vector<PlacedPart>* side : {&std::as_const(at_end), &rest})
    for (const PlacedPart& p : *side) {
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(boxes_[p.part].size().norm() / 2);
      const Eigen::Vector3d center = p.pose * boxes_[p.part].center();
      all.extend(center - reach);
      all.extend(center + reach);
    }
  const double length = (1 + kBeyond) * hulls.distance(out, all.size().norm(), kBisections);
  path.emplace_back();
  for (const PlacedPart& p : at_end) path.back().push_back({p.pose.t + length * out, p.pose.q});
}

std::vector<geometry::PlacedHull> StraightPaths::hulls_of(const std::vector<PlacedPart>& parts) {
  std::vector<geometry::PlacedHull> out;
  for (const PlacedPart& p : parts) {
    const Mesh& mesh = *assembly_.parts[p.part].mesh;
    if (corners_[p.part].empty()) corners_[p.part] = hull_corners(mesh.vertices);
    out.push_back({&mesh, &boxes_[p.part], &corners_[p.part], p.pose});
  }
  return out;
}

}  // namespace dismantle
