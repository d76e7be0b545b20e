#include "removals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/geometry/boxes_along.h"
#include "dismantle/part_set.h"
#include "own_axes.h"

namespace dismantle {

using Eigen::Vector3d;
using order::kForbidden;
using order::kNone;
using order::UnitSet;
using order::VariantId;

namespace {

constexpr double kSameDirection = 1 - 1e-9;  // cosine
constexpr std::size_t kMostUsed = 12;        // directions of the plan that are tried for every part

bool is_straight(const Path& path) {
  const Vector3d out = last_direction(path);
  for (std::size_t i = 0; i < path.front().size(); ++i)
    for (const std::vector<Pose>& poses : path) {
      const Vector3d displacement = poses[i].t - path.front()[i].t;
      if (!poses[i].q.isApprox(path.front()[i].q, 1e-12) ||
          (displacement - displacement.dot(out) * out).norm() > 1e-9 * (1 + displacement.norm()) ||
          displacement.dot(out) < 0)
        return false;
    }
  return !out.isZero();
}

}  // namespace

Vector3d last_direction(const Path& path) {
  if (path.size() < 2) return Vector3d::Zero();
  const Vector3d displacement = path.back().front().t - path[path.size() - 2].front().t;
  return displacement.norm() > 1e-12 ? Vector3d(displacement.normalized()) : Vector3d(Vector3d::Zero());
}

Removals::Removals(const Assembly& assembly, const Disassembly& plan, const Constraints& constraints,
                   const Objective& objective, const Verifier& verifier, const RunContext& context)
    : assembly_(assembly), constraints_(constraints), objective_(objective), verifier_(verifier), context_(context) {
  Aabb all;
  for (const Part& part : assembly.parts) all.extend(part.mesh->box());
  if (!all.empty()) far_ = 1.1 * all.size().norm();
  add_units();
  of_unit_.resize(units());
  in_group_ = UnitSet(units());
  add_planned(plan);
  std::vector<Vector3d> used;
  for (const Motion& motion : motions_)
    if (used.size() < kMostUsed && !motion.out.isZero() &&
        std::none_of(used.begin(), used.end(), [&](const Vector3d& d) { return d.dot(motion.out) > kSameDirection; }))
      used.push_back(motion.out);
  for (std::size_t u = 0; u < units(); ++u) add_straight(u, used);
  find_least();
}

void Removals::add_units() {
  const std::vector<PartId> kept = kept_sets(assembly_.parts.size(), constraints_);
  std::map<PartId, std::size_t> unit_of_set;
  unit_of_.resize(assembly_.parts.size());
  for (const Part& part : assembly_.parts) {
    const auto [known, is_new] = unit_of_set.try_emplace(kept[part.id], parts_.size());
    if (is_new) parts_.emplace_back();
    unit_of_[part.id] = known->second;
    parts_[known->second].push_back(part.id);
  }
  needs_gone_.assign(units(), UnitSet(units()));
  for (const auto& [first, then] : constraints_.before)
    if (unit_of_[first] != unit_of_[then]) needs_gone_[unit_of_[then]].insert(unit_of_[first]);
}

/// A step out of a group that has been moved as a whole is the same where the group stood at first.
void Removals::add_planned(const Disassembly& plan) {
  for (std::size_t k = 0; k < plan.steps().size(); ++k) {
    const DisassemblyStep& step = plan.steps()[k];
    if (step.forced || step.placement || step.released || step.path->size() < 2) continue;
    const std::size_t group = plan.left_group(k);
    const Pose& at = plan.pose(step.parts.front(), k);
    const auto stands = [&](PartId id) {
      const Pose& own = plan.pose(id, k);
      return (own.t - at.t).norm() < 1e-9 * far_ && own.q.isApprox(at.q, 1e-9);
    };
    Motion motion{UnitSet(units()), UnitSet(units()), UnitSet(units()), UnitSet(units()), step.parts, {}, {}, false, 0};
    bool moved_as_one = true;
    UnitSet rest(units());
    for (const Part& part : assembly_.parts) {
      if (plan.group(part.id, k) != group) continue;
      moved_as_one = moved_as_one && stands(part.id);
      (contains(step.parts, part.id) ? motion.units : rest).insert(unit_of_[part.id]);
    }
    if (!moved_as_one || motion.units.intersects(rest)) continue;
    const Pose back = at.inverse();
    for (const std::vector<Pose>& poses : *step.path) {
      motion.path.emplace_back();
      for (const Pose& pose : poses) motion.path.back().push_back(back * pose);
    }
    for (Pose& pose : motion.path.front()) pose = Pose{};
    motion.out = last_direction(motion.path);
    // A straight one is looked at again, on a path as long as it takes to be past everything.
    if (is_straight(motion.path))
      motion.straight = true,
      motion.path = {motion.path.front(), std::vector<Pose>(motion.parts.size(), {far_ * motion.out, Pose{}.q})};
    else
      motion.free = rest;
    add(std::move(motion));
  }
}

void Removals::add_straight(std::size_t unit, const std::vector<Vector3d>& used) {
  for (const PartId id : parts_[unit])
    if (contains(constraints_.base, id)) return;
  std::vector<Vector3d> all;
  for (const Vector3d& axis : own_axes(parts_[unit], assembly_)) {
    all.push_back(axis);
    all.push_back(-axis);
  }
  all.insert(all.end(), used.begin(), used.end());
  // From above first, then from the side: of directions that cost the same, the first is taken.
  std::stable_sort(all.begin(), all.begin() + 6, [&](const Vector3d& a, const Vector3d& b) {
    return a.dot(objective_.up) > b.dot(objective_.up) + 1e-9;
  });
  for (const Vector3d& out : all) {
    const bool known = std::any_of(of_unit_[unit].begin(), of_unit_[unit].end(), [&](VariantId v) {
      return motions_[v].straight && motions_[v].units.size() == 1 && motions_[v].out.dot(out) > kSameDirection;
    });
    if (known) continue;
    const std::vector<PartId>& parts = parts_[unit];
    Motion motion{UnitSet(units()), UnitSet(units()), UnitSet(units()), UnitSet(units()), parts, {}, out, true, 0};
    motion.units.insert(unit);
    motion.path = {std::vector<Pose>(parts.size()), std::vector<Pose>(parts.size(), Pose{far_ * out, Pose{}.q})};
    add(std::move(motion));
  }
}

void Removals::add(Motion motion) {
  std::size_t first = 0;
  while (!motion.units.contains(first)) ++first;
  if (motion.units.size() > 1) in_group_ |= motion.units;
  of_unit_[first].push_back(motions_.size());
  motions_.push_back(std::move(motion));
}

/// What a check says that reads nothing but the motion is known before an order is.
void Removals::find_least() {
  for (const ObjectiveItem& item : objective_.items) {
    const StepCheckTraits t = item.check->traits();
    if (t.reads_present || t.reads_path || t.remembers_direction || t.remembers_orientation || t.remembers_shape)
      continue;
    for (VariantId v = 0; v < motions_.size(); ++v)
      motions_[v].least += item.weight * judge(item, v, UnitSet(units()), kNone).cost;
  }
}

bool Removals::may_leave(VariantId v, const UnitSet& present) {
  Motion& motion = motions_[v];
  if (motion.blocking.intersects(present)) return false;
  bool held = false;
  motion.units.each([&](std::size_t u) { held = held || needs_gone_[u].intersects(present - motion.units); });
  if (held) return false;
  bool free = true;
  (present - motion.free - motion.units).each([&](std::size_t u) {
    if (!free) return;
    free = !obstructs(motion, u);
    (free ? motion.free : motion.blocking).insert(u);
  });
  return free;
}

const UnitSet& Removals::blocking(VariantId v) {
  Motion& motion = motions_[v];
  std::vector<std::size_t> open;
  (UnitSet(units(), true) - motion.free - motion.blocking - motion.units).each([&](std::size_t u) {
    open.push_back(u);
  });
  std::vector<char> answers(open.size());
  parallel_for(
      open.size(), context_, [&](std::size_t i) { answers[i] = obstructs(motion, open[i]) ? 1 : 0; },
      [] { return false; });
  for (std::size_t i = 0; i < open.size(); ++i) (answers[i] != 0 ? motion.blocking : motion.free).insert(open[i]);
  motion.needs = motion.blocking;
  motion.units.each([&](std::size_t u) { motion.needs |= needs_gone_[u]; });
  motion.needs -= motion.units;
  return motion.needs;
}

bool Removals::obstructs(const Motion& motion, std::size_t unit) const {
  for (std::size_t column = 0; column < motion.parts.size(); ++column)
    for (const PartId other : parts_[unit])
      if (meets(motion, column, other)) return true;
  return false;
}

bool Removals::meets(const Motion& motion, std::size_t column, PartId other) const {
  const PartId part = motion.parts[column];
  if (motion.straight &&
      !geometry::meets_along(assembly_.parts[part].mesh->box(), assembly_.parts[other].mesh->box(), motion.out))
    return false;
  std::vector<Pose> path;
  for (const std::vector<Pose>& poses : motion.path) path.push_back(poses[column]);
  if (!verifier_.passes(part, other, Pose{}, path)) return true;
  return !motion.straight && !verifier_.apart({{part, path.back()}}, {{other, Pose{}}});
}

bool Removals::confirm(VariantId v, const UnitSet& present) {
  Motion& motion = motions_[v];
  if (motion.straight) return true;  // pair by pair
  const std::vector<PlacedPart> fixed = placed(present - motion.units);
  std::vector<PlacedPart> at_end;
  for (std::size_t i = 0; i < motion.parts.size(); ++i) at_end.push_back({motion.parts[i], motion.path.back()[i]});
  if (verifier_.apart(at_end, fixed) && verifier_.check_motion(motion.parts, fixed, motion.path, context_).valid)
    return true;
  // The plan has it with less around it.
  motion.blocking |= present - motion.units;
  motion.free -= present;
  exact_ = false;
  return false;
}

bool Removals::alike(VariantId a, VariantId b) const { return motions_[a].out.dot(motions_[b].out) > kSameDirection; }

bool Removals::remembers() const {
  return std::any_of(objective_.items.begin(), objective_.items.end(), [&](const ObjectiveItem& item) {
    const StepCheckTraits t = item.check->traits();
    return (by_objective_ || item.require) && (t.remembers_direction || t.remembers_orientation || t.remembers_shape);
  });
}

double Removals::cost(VariantId v, const UnitSet& rest, VariantId previous) {
  double sum = by_objective_ ? kStep : 1;
  for (std::size_t i = 0; i < objective_.items.size(); ++i) {
    const ObjectiveItem& item = objective_.items[i];
    if (!by_objective_ && !item.require) continue;
    const StepCheckTraits t = item.check->traits();
    const bool reads_previous = t.remembers_direction || t.remembers_orientation || t.remembers_shape;
    CostKey key{i, v, reads_previous ? previous : kNone, t.reads_present ? rest : UnitSet()};
    auto known = costs_.find(key);
    if (known == costs_.end()) {
      const StepVerdict verdict = judge(item, v, rest, key.previous);
      known = costs_.emplace(std::move(key), item.require && !verdict.allowed ? kForbidden : item.weight * verdict.cost)
                  .first;
    }
    if (known->second == kForbidden) return kForbidden;
    if (by_objective_) sum += known->second;
  }
  return sum;
}

StepVerdict Removals::judge(const ObjectiveItem& item, VariantId v, const UnitSet& rest, VariantId previous) const {
  const std::vector<PlacedPart> moving = placed(motions_[v].units), present = placed(rest);
  std::vector<PlacedPart> put_in;
  if (previous != kNone) put_in = placed(motions_[previous].units);
  const StepQuestion before{
      assembly_, put_in,       {}, previous == kNone ? Vector3d(Vector3d::Zero()) : Vector3d(-motions_[previous].out),
      nullptr,   objective_.up};
  const StepQuestion question{assembly_,
                              moving,
                              present,
                              Vector3d(-motions_[v].out),
                              nullptr,
                              objective_.up,
                              previous == kNone ? nullptr : &before};
  try {
    StepVerdict verdict = item.check->judge(question, context_);
    if (!(verdict.cost >= 0)) throw Error("its cost is not a number from 0 on");
    return verdict;
  } catch (const std::exception& e) {
    throw Error(fmt::format("step check '{}': {}", item.id, e.what()));
  }
}

std::vector<PlacedPart> Removals::placed(const UnitSet& units) const {
  std::vector<PlacedPart> list;
  units.each([&](std::size_t u) {
    for (const PartId id : parts_[u]) list.push_back({id, Pose{}});
  });
  std::sort(list.begin(), list.end(), [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; });
  return list;
}

std::vector<PartId> Removals::leaving_parts(VariantId v) const { return motions_[v].parts; }

}  // namespace dismantle
