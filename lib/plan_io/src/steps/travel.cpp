#include "dismantle/plan_io/travel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_history.h"

namespace dismantle {
namespace {

/// A half-plane normal . x <= offset across the direction.
struct HalfPlane {
  Eigen::Vector2d normal;
  double offset = 0;
};

/// Corners counter-clockwise (A. M. Andrew, Information Processing Letters 9(5), 1979).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::ranges::sort(points, before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Eigen::Vector2d> hull;
  const auto add = [&](const Eigen::Vector2d& p, std::size_t keep) {
    const auto turns_right = [&] {
      const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
      return a.x() * b.y() - a.y() * b.x() <= 0;
    };
    while (hull.size() > keep && turns_right()) hull.pop_back();
    hull.push_back(p);
  };
  for (const auto& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (auto p = points.rbegin() + 1; p < points.rend(); ++p) add(*p, lower);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

/// The silhouette of moving parts, and what of other parts is within it.
class Silhouette {
 public:
  Silhouette(const Assembly& assembly, const PosedParts& moving, const Eigen::Vector3d& direction)
      : assembly_(assembly) {
    const Eigen::Vector3d up = direction.normalized(), side = up.unitOrthogonal();
    axes_ << side.transpose(), up.cross(side).transpose(), up.transpose();
    std::vector<Eigen::Vector2d> points;
    for (const auto& [part, pose] : moving)
      for (const Eigen::Vector3d& v : vertices(part, pose)) {
        points.emplace_back(v.head<2>());
        rear_ = std::min(rear_, v.z());
      }
    widen(convex_hull(std::move(points)));
  }

  double rear() const { return rear_; }

  /// Raises `top` to the largest height of the part within the silhouette.
  void raise(std::size_t part, const Pose& pose, double& top) const {
    if (!may_raise(part, pose, top)) return;
    const std::vector<Eigen::Vector3d> at = vertices(part, pose);
    std::vector<Eigen::Vector3d> polygon;
    for (const auto& triangle : assembly_.parts.at(part).mesh->triangles) {
      polygon.assign({at[triangle[0]], at[triangle[1]], at[triangle[2]]});
      if (std::ranges::all_of(polygon, [&](const Eigen::Vector3d& p) { return p.z() <= top; })) continue;
      clip(polygon);
      for (const Eigen::Vector3d& p : polygon) top = std::max(top, p.z());
    }
  }

 private:
  /// In the axes of the silhouette, input units.
  std::vector<Eigen::Vector3d> vertices(std::size_t part, const Pose& pose) const {
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector3d& v : assembly_.parts.at(part).mesh->vertices)
      out.push_back(axes_ * (pose * assembly_.normalization.to_input(v)));
    return out;
  }

  bool may_raise(std::size_t part, const Pose& pose, double top) const {
    const Aabb own = assembly_.parts.at(part).mesh->box();
    Aabb box;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d c(corner & 1 ? own.hi.x() : own.lo.x(), corner & 2 ? own.hi.y() : own.lo.y(),
                              corner & 4 ? own.hi.z() : own.lo.z());
      box.extend(axes_ * (pose * assembly_.normalization.to_input(c)));
    }
    return box.hi.z() > top && (box.lo.head<2>().array() <= high_.array()).all() &&
           (box.hi.head<2>().array() >= low_.array()).all();
  }

  void widen(const std::vector<Eigen::Vector2d>& hull) {
    double area = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
      area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    const double margin = 0.05 * std::sqrt(std::max(area, 0.0));
    for (std::size_t i = 0; i < hull.size() && hull.size() > 2; ++i) {
      const Eigen::Vector2d edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized(), normal(edge.y(), -edge.x());
      sides_.push_back({normal, normal.dot(hull[i]) + margin});
    }
    for (const Eigen::Vector2d& p : hull) {
      low_ = low_.cwiseMin((p.array() - margin).matrix());
      high_ = high_.cwiseMax((p.array() + margin).matrix());
    }
  }

  /// I. E. Sutherland and G. W. Hodgman, Communications of the ACM 17(1), 1974.
  void clip(std::vector<Eigen::Vector3d>& polygon) const {
    std::vector<Eigen::Vector3d> inside;
    for (const HalfPlane& side : sides_) {
      inside.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = side.normal.dot(a.head<2>()) - side.offset, db = side.normal.dot(b.head<2>()) - side.offset;
        if (da <= 0) inside.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) inside.push_back(a + (b - a) * (da / (da - db)));
      }
      polygon.swap(inside);
      if (polygon.empty()) return;
    }
  }

  const Assembly& assembly_;
  Eigen::Matrix3d axes_;  // rows: across, across, along
  std::vector<HalfPlane> sides_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
  double rear_ = std::numeric_limits<double>::infinity();
};

/// The guided distance of a step, if it is one rigid and straight motion by which parts leave their group.
std::optional<double> distance_of(const PlanStep& step, const PlanHistory& history, std::size_t index,
                                  const Assembly& assembly, const std::vector<std::size_t>& part_of) {
  if (history.splits(index).size() != 1 || step.moves.empty()) return std::nullopt;
  const auto& poses = step.moves.front().poses;
  const double size = assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff();
  const Aabb box = assembly.parts[part_of[history.index_of(step.moves.front().part)]].mesh->box();
  const MotionSummary motion =
      summarize_motion(poses, assembly.normalization.to_input(box.center()), stretch_tolerance(size));
  if (!is_straight(motion)) return std::nullopt;
  const Pose whole = poses.back() * poses.front().inverse();
  std::vector<bool> moves(history.parts());
  PosedParts moving, fixed;
  for (const PlanMove& move : step.moves) {
    const Pose own = move.poses.back() * move.poses.front().inverse();
    const double otherwise = (own.t - whole.t).norm() + size * angle_between(own.q, whole.q);
    if (otherwise > resting_distance(size)) return std::nullopt;
    const std::size_t i = history.index_of(move.part);
    moves[i] = true;
    moving.emplace_back(part_of[i], move.poses.front());
  }
  for (const std::size_t i : history.members(history.splits(index).front().from, index))
    if (!moves[i]) fixed.emplace_back(part_of[i], history.pose_of(i, index));
  return std::min(guided_distance(assembly, moving, fixed, motion.stretches.front()), motion.length);
}

}  // namespace

double guided_distance(const Assembly& assembly, const PosedParts& moving, const PosedParts& fixed,
                       const Eigen::Vector3d& direction) {
  const Silhouette silhouette(assembly, moving, direction);
  double top = silhouette.rear();
  for (const auto& [part, pose] : fixed) silhouette.raise(part, pose, top);
  return top - silhouette.rear();
}

GuidedDistances guided_distances(const Plan& plan, const Assembly& assembly) {
  const PlanHistory history(plan);
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) index.emplace(assembly.parts[i].name, i);
  std::vector<std::size_t> part_of;
  for (const PlanPart& part : plan.assembly.parts) {
    const auto known = index.find(part.name);
    if (known == index.end()) throw InputError(part.name, "the plan has a part that the assembly lacks");
    part_of.push_back(known->second);
  }
  GuidedDistances out;
  for (std::size_t s = 0; s < plan.disassembly.size(); ++s)
    out.push_back(distance_of(plan.disassembly[s], history, s, assembly, part_of));
  return out;
}

bool is_straight(const MotionSummary& motion) {
  return motion.stretches.size() == 1 && motion.turn * 180 / std::numbers::pi < 1;
}

double stated_distance(const MotionSummary& motion, std::optional<double> guided, double size) {
  if (!guided || !is_straight(motion)) return motion.length;
  return *guided <= resting_distance(size) ? 0 : *guided;
}

std::string travel_words(const MotionSummary& motion, std::optional<double> guided, const MotionPhrase& phrase,
                         const Eigen::Quaterniond& lies) {
  MotionSummary shown = in_unit(motion, phrase.unit.factor);
  if (guided && is_straight(motion)) {
    if (stated_distance(motion, guided, phrase.size) == 0)
      return direction_words(motion.stretches.front(), phrase.up, lies) +
             (phrase.disassembly ? ", free at once" : ", until it seats");
    shown.stretches.front() *= *guided / motion.stretches.front().norm();
  }
  return motion_words(shown, phrase.unit.name, phrase.up, lies);
}

}  // namespace dismantle
