#include "dismantle/plan_io/explode.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_history.h"

namespace dismantle {
namespace {

using Offsets = std::vector<Eigen::Vector3d>;
using PartIndices = std::span<const std::size_t>;

/// Boxes of the plan's parts, assembled, input units.
std::vector<Aabb> boxes_of(const Plan& plan, const Assembly& assembly) {
  std::map<std::string, Aabb> by_name;
  for (const Part& part : assembly.parts) {
    Aabb& box = by_name[part.name];
    const Aabb internal = part.mesh->box();
    box.extend(assembly.normalization.to_input(internal.lo));
    box.extend(assembly.normalization.to_input(internal.hi));
  }
  std::vector<Aabb> out;
  for (const PlanPart& part : plan.assembly.parts) {
    const auto it = by_name.find(part.name);
    if (it == by_name.end()) throw InputError(part.name, "the plan has a part that the assembly lacks");
    out.push_back(it->second);
  }
  return out;
}

/// Mean displacement of the box centres of the parts of `group` that the step moves; zero if it moves none.
Eigen::Vector3d mean_displacement(const PlanStep& step, const PlanHistory& history, std::size_t group, std::size_t done,
                                  const std::vector<Aabb>& boxes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const PlanMove& move : step.moves) {
    const std::size_t i = history.index_of(move.part);
    if (history.group_of(i, done) != group || move.poses.empty()) continue;
    sum += move.poses.back() * boxes[i].center() - move.poses.front() * boxes[i].center();
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

/// How far `a` must move along `u` until it has passed `b`; 0 if they do not meet.
double passing(const Aabb& a, const Aabb& b, const Eigen::Vector3d& u, double gap) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double lo = b.lo[k] - a.hi[k] - gap, hi = b.hi[k] - a.lo[k] + gap;
    if (std::abs(u[k]) < 1e-6) {
      if (lo >= 0 || hi <= 0) return 0;
      continue;
    }
    enter = std::max(enter, std::min(lo / u[k], hi / u[k]));
    leave = std::min(leave, std::max(lo / u[k], hi / u[k]));
  }
  return leave > enter ? leave : 0;
}

Aabb shifted(Aabb box, const Eigen::Vector3d& by) {
  box.lo += by;
  box.hi += by;
  return box;
}

}  // namespace

Offsets exploded_offsets(const Plan& plan, const Assembly& assembly) {
  const std::vector<Aabb> boxes = boxes_of(plan, assembly);
  const PlanHistory history(plan);
  Aabb all;
  for (const Aabb& box : boxes) all.extend(box);
  Offsets offsets(boxes.size(), Eigen::Vector3d::Zero());
  if (all.empty()) return offsets;
  const double size = all.size().maxCoeff();
  const double gap = 0.04 * size;  // between boxes

  // In reverse, as in assembly: a group is already exploded when it has to keep clear of the rest.
  for (std::size_t s = plan.disassembly.size(); s-- > 0;)
    for (const GroupSplit& split : history.splits(s)) {
      const PartIndices rest = history.members(split.from, s + 1);
      std::vector<std::size_t> obstacles(rest.begin(), rest.end());
      for (const std::size_t group : split.out) {
        const PlanStep& step = plan.disassembly[s];
        const PartIndices piece = history.members(group, s + 1);
        Eigen::Vector3d u = mean_displacement(step, history, group, s + 1, boxes) -
                            mean_displacement(step, history, split.from, s + 1, boxes);
        if (!(u.norm() > 1e-9 * size)) {  // rotation only: move away from the centre
          u.setZero();
          for (const std::size_t i : piece) u += boxes[i].center() - all.center();
        }
        u = u.norm() > 1e-9 * size ? Eigen::Vector3d(u.normalized()) : Eigen::Vector3d::UnitZ();
        double far = 2 * gap;
        for (const std::size_t i : piece)
          for (const std::size_t j : obstacles)
            far = std::max(far, passing(shifted(boxes[i], offsets[i]), shifted(boxes[j], offsets[j]), u, gap));
        for (const std::size_t i : piece) offsets[i] += far * u;
        obstacles.insert(obstacles.end(), piece.begin(), piece.end());
      }
    }
  return offsets;
}

}  // namespace dismantle
