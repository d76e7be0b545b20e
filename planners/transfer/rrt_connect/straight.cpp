#include "straight.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/swept_boxes.h"

namespace dismantle::rrt_connect {
namespace {

using Eigen::Vector3d;

/// The axis that `v` lies along, if it is one to the last bit.
std::optional<Eigen::Index> axis_of(const Vector3d& v) {
  Eigen::Index axis = 0;
  if (v.cwiseAbs().maxCoeff(&axis) != 1 || v.cwiseAbs().sum() != 1) return std::nullopt;
  return axis;
}

/// The largest coordinate of the parts in direction `v`. Only parts whose box reaches further than the maximum so far
/// have their vertices visited; unturned parts along an axis, which are most, none at all: rounding is monotonic, so
/// that the box says the same.
double reach(const Assembly& assembly, PartBoxes& boxes, const std::vector<PlacedPart>& parts, const Pose& displacement,
             const Vector3d& v) {
  double most = -std::numeric_limits<double>::infinity();
  const std::optional<Eigen::Index> axis = axis_of(v);
  const bool unturned = displacement.q.vec().isZero(0);
  std::vector<std::pair<double, std::size_t>> tops;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PlacedPart& p = parts[i];
    const Aabb& box = boxes.of(assembly.parts[p.part]);
    if (axis && unturned && p.pose.q.vec().isZero(0)) {
      const double at = p.pose.t[*axis] + displacement.t[*axis];
      most = std::max(most, v[*axis] > 0 ? box.hi[*axis] + at : -(box.lo[*axis] + at));
    } else {
      tops.emplace_back(geometry::top_of(box, displacement * p.pose, v), i);
    }
  }
  const auto visit = [&](std::size_t i) {
    const Pose pose = displacement * parts[i].pose;
    for (const auto& x : assembly.parts[parts[i].part].mesh->vertices) most = std::max(most, v.dot(pose * x));
  };
  const auto highest = std::max_element(tops.begin(), tops.end());
  if (highest != tops.end() && highest->first > most) visit(highest->second);
  for (const auto& [top, i] : tops)
    if (top > most) visit(i);
  return most;
}

Pose shift(const Vector3d& direction) { return {direction, Eigen::Quaterniond::Identity()}; }

}  // namespace

bool displacement_to_goal(const TransferQuery& query, Pose& displacement) {
  const auto& moving = query.scene.moving;
  if (moving.empty() || query.goal.size() != moving.size()) return false;
  displacement = query.goal[0] * moving[0].pose.inverse();
  for (std::size_t i = 1; i < moving.size(); ++i) {
    const Pose there = displacement * moving[i].pose;
    // Poses are read from files with about ten digits.
    const double rounding = 10 * geometry::kRounding;
    const double size = displacement.t.norm() + moving[i].pose.t.norm();
    if ((there.t - query.goal[i].t).norm() > rounding * size || angle_between(there.q, query.goal[i].q) > 10 * rounding)
      return false;
  }
  return true;
}

const Aabb& PartBoxes::of(const Part& part) {
  if (known_.size() <= part.id) known_.resize(part.id + 1);
  Known& known = known_[part.id];
  if (known.mesh != part.mesh) known = {part.mesh, part.mesh->box()};
  return known.box;
}

StraightTransfers::StraightTransfers(const TransferQuery& query, double clearance, PartBoxes& boxes)
    : query_(query), clearance_(clearance), boxes_(boxes) {
  rigid_ = displacement_to_goal(query, goal_);
  const auto each = [&](const auto& visit) {
    for (const auto& m : query.scene.moving)
      for (const auto& v : query.assembly.parts[m.part].mesh->vertices) visit(m.pose * v);
  };
  Aabb box;
  each([&](const Vector3d& p) { box.extend(p); });
  center_ = box.center();
  each([&](const Vector3d& p) { radius_ = std::max(radius_, (p - center_).norm()); });
}

std::optional<Path> StraightTransfers::path(std::size_t k) const {
  if (!rigid_) return std::nullopt;
  if (query_.scene.fixed.empty()) k += 2;  // there is nothing to go over
  const Vector3d up = query_.up, side = up.unitOrthogonal(), across = up.cross(side);
  const bool last = query_.scene.fixed.empty() || k > 6;
  switch (k) {
    case 0:
      return over(up);
    case 1:
      return over(-up);
    case 2:
      return path_of({Pose{}, Pose{center_ - goal_.q * center_, goal_.q}, goal_});
    default:
      break;
  }
  if (last) return std::nullopt;
  const Vector3d sides[] = {side, -side, across, -across};
  return over(sides[k - 3]);
}

Path StraightTransfers::path_of(const std::vector<Pose>& displacements) const {
  Path path;
  for (const auto& d : displacements) {
    path.emplace_back();
    for (const auto& m : query_.scene.moving) path.back().push_back(d * m.pose);
  }
  path.back() = query_.goal;
  return path;
}

Path StraightTransfers::over(const Vector3d& v) const {
  const bool turns = angle_between(goal_.q, Eigen::Quaterniond::Identity()) > 1e-9;
  const Vector3d there = goal_ * center_;
  // A group that rotates must clear the obstacles by its bounding sphere, another one only by its own extent.
  const double own_start = -reach(query_.assembly, boxes_, query_.scene.moving, {}, -v);
  const double own_goal = -reach(query_.assembly, boxes_, query_.scene.moving, goal_, -v);
  const double lowest_start = turns ? v.dot(center_) - radius_ : own_start;
  const double lowest_goal = turns ? v.dot(there) - radius_ : own_goal;
  const double top = reach(query_.assembly, boxes_, query_.scene.fixed, {}, v) + clearance_;
  // Height of the ball's centre at which the group clears everything, not below either end.
  const double height =
      std::max({v.dot(center_) + std::max(0.0, top - lowest_start), v.dot(there) + std::max(0.0, top - lowest_goal)});
  const Pose lifted = shift((height - v.dot(center_)) * v);
  const Pose above = shift((height - v.dot(there)) * v) * goal_;
  const Vector3d c = lifted * center_;
  const Pose turned{c - goal_.q * center_, goal_.q};
  return path_of({Pose{}, lifted, turned, above, goal_});
}

}  // namespace dismantle::rrt_connect
