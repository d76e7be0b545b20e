#include "plan/plan_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle {
namespace {

bool usable(const Pose& p) { return p.t.allFinite() && p.q.coeffs().allFinite() && std::abs(p.q.norm() - 1) <= 1e-6; }

/// Does a point of a mesh travel further than `most` from one pose to the next? On a screw the speed of a point is
/// convex in its place, so that a corner of the hull travels furthest.
class Travel {
 public:
  Travel(const Mesh& mesh, double most) : mesh_(mesh), box_(mesh.box()), most_(most) {}

  bool too_far(const Pose& a, const Pose& b) {
    if (screw_travel(a, b, box_.center(), 0.5 * box_.size().norm()) <= most_) return false;
    if (corners_.empty()) corners_ = hull_corners(mesh_.vertices);
    // A displacement across the axis is the chord of an arc.
    const Eigen::Vector3d turn = rotation_vector(b.q * a.q.conjugate());
    const double half = 0.5 * turn.norm(), arc = half > geometry::kRounding ? half / std::sin(half) : 1;
    const Eigen::Vector3d axis = turn.stableNormalized(), shift = b.t - a.t;
    const Eigen::Matrix3d rotated = b.q.toRotationMatrix() - a.q.toRotationMatrix();
    return std::ranges::any_of(corners_, [&](const Eigen::Vector3d& v) {
      const Eigen::Vector3d moved = rotated * v + shift;
      const double along = axis.dot(moved), chord = moved.squaredNorm() - along * along;
      return along * along + arc * arc * chord > most_ * most_;
    });
  }

 private:
  const Mesh& mesh_;
  Aabb box_;
  double most_;
  std::vector<Eigen::Vector3d> corners_;
};

}  // namespace

PlanState::PlanState(const Assembly& assembly) : place(assembly.parts.size()), groups(1), assembly_(&assembly) {
  Aabb box;
  for (const auto& part : assembly.parts) {
    ids_.emplace(part.name, static_cast<PartId>(groups[0].size()));
    groups[0].push_back(static_cast<PartId>(groups[0].size()));
    box.extend(part.mesh->box());
  }
  if (!box.empty()) size_ = box.size().maxCoeff();
}

std::optional<PartId> PlanState::find(const std::string& name) const {
  const auto it = ids_.find(name);
  if (it == ids_.end()) return std::nullopt;
  return it->second;
}

std::optional<StepMotion> PlanState::read(const std::vector<PlanMove>& moves,
                                          std::vector<std::string>& problems) const {
  const std::size_t before = problems.size();
  if (moves.empty()) {
    problems.emplace_back("it moves no part");
    return std::nullopt;
  }
  StepMotion motion;
  std::set<std::string> seen;
  for (const auto& move : moves) {
    const auto id = find(move.part);
    if (!id) {
      problems.push_back(fmt::format("part '{}' is not in the assembly", move.part));
      continue;
    }
    if (!seen.insert(move.part).second) problems.push_back(fmt::format("part '{}' has two moves", move.part));
    if (move.poses.size() < 2) problems.push_back(fmt::format("the move of '{}' has less than two poses", move.part));
    if (move.poses.size() != moves.front().poses.size())
      problems.push_back(fmt::format("'{}' has {} poses, '{}' has {}: all moves of a step need the same number",
                                     move.part, move.poses.size(), moves.front().part, moves.front().poses.size()));
    for (std::size_t k = 0; k < move.poses.size(); ++k)
      if (!usable(move.poses[k])) {
        problems.push_back(
            fmt::format("pose {} of '{}' is not finite or its quaternion not of unit length", k, move.part));
        break;
      }
    motion.moving.push_back(*id);
  }
  if (problems.size() != before) return std::nullopt;

  motion.path.resize(moves.front().poses.size());
  for (const auto& move : moves)
    for (std::size_t k = 0; k < move.poses.size(); ++k) {
      const Pose unit{move.poses[k].t, move.poses[k].q.normalized()};
      motion.path[k].push_back(assembly_->normalization.pose_to_internal(unit));
    }
  const double most = 0.01 * size_ * (1 + geometry::kRounding);  // rule of the plan format: 1 % of the largest edge
  for (std::size_t i = 0; i < motion.moving.size(); ++i) {
    Travel travel(*assembly_->parts[motion.moving[i]].mesh, most);
    for (std::size_t k = 0; k + 1 < motion.path.size(); ++k)
      if (travel.too_far(motion.path[k][i], motion.path[k + 1][i])) {
        problems.push_back(fmt::format("'{}' travels more than 1 % of the assembly's size from pose {} to the next",
                                       name(motion.moving[i]), k));
        break;
      }
  }
  return motion;
}

bool PlanState::does(const PlanAsked& asked) const {
  std::vector<std::vector<std::string>> names;
  for (const auto& group : groups) {
    names.emplace_back();
    for (const PartId id : group) names.back().push_back(name(id));
  }
  return is_done(asked, names);
}

double PlanState::offset(PartId id, const Pose& a, const Pose& b) const {
  const Aabb box = assembly_->parts[id].mesh->box();
  double worst = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d c(k & 1 ? box.hi.x() : box.lo.x(), k & 2 ? box.hi.y() : box.lo.y(),
                            k & 4 ? box.hi.z() : box.lo.z());
    worst = std::max(worst, (a * c - b * c).norm());
  }
  return worst;
}

std::optional<std::string> PlanState::wrong_start(PartId id, const Pose& start) const {
  const double off = offset(id, start, place[id]);
  if (off <= tolerance()) return std::nullopt;
  return fmt::format("'{}' starts {:.3g} assembly units from where it is", name(id), off);
}

}  // namespace dismantle
