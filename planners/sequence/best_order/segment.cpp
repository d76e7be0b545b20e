#include "best_order/segment.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/part_set.h"

namespace dismantle::order {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kClasses = 63;  // of variants; the last one is for all others

bool same(const Vector3d& a, const Vector3d& b) {
  return a.dot(b) > geometry::kSameDirection || (a.isZero() && b.isZero());
}

Vector3d insertion_of(const Assembly& assembly, const Removal& removal) {
  const AttemptResult& answer = *removal.attempt;
  return Operation(assembly, answer.attempt.moving, {}, answer.path(), Vector3d::UnitZ()).question().direction;
}

/// Of a direction of insertion (unit, or zero) and of up: along an axis, and from above.
double preference_of(const Vector3d& insertion, const Vector3d& up) {
  if (insertion.isZero()) return 0;
  const double along = insertion.cwiseAbs().maxCoeff(), upwards = insertion.dot(up);
  constexpr double kAlong = 0.9998, kSteep = 0.7;  // within 1, and 45, degrees
  return kPreference * ((along > kAlong ? 0 : 4) + (upwards > kSteep ? 2 : upwards > -kSteep ? 1 : 0));
}

}  // namespace

bool is_straight(const Path& path) {
  for (std::size_t i = 0; i < path.front().size(); ++i) {
    const Vector3d whole = path.back()[i].t - path.front()[i].t;
    for (const auto& poses : path) {
      const Vector3d part = poses[i].t - path.front()[i].t;
      if (!poses[i].q.isApprox(path.front()[i].q, 1e-12) ||
          (part - part.dot(whole) / std::max(whole.squaredNorm(), 1e-300) * whole).norm() > 1e-9 * (1 + whole.norm()))
        return false;
    }
  }
  return true;
}

Segment::Segment(OrderScene& scene, std::vector<PlacedPart> start, std::vector<const Removal*> planned)
    : scene_(scene), start_(std::move(start)) {
  prepare();
  add_units(planned);
  add_moves(planned);
  add_variants();
  find_bounds();
}

Segment::Segment(OrderScene& scene, std::vector<PlacedPart> start, std::vector<const Removal*> planned, ToTarget)
    : scene_(scene), start_(std::move(start)) {
  prepare();
  add_kept_units();
  UnitSet present(units(), true);
  for (const Removal* removal : planned) {
    for (const PartId id : removal->parts) present.erase(unit_of_.at(id));
    add_planned(removal, present);
    if (moves_.back().units.size() > 1) in_group_ |= moves_.back().units;
  }
  for (std::size_t u = 0; scene_.sweep != nullptr && u < units(); ++u) add_straight(u);
  add_variants();
  find_bounds();
}

void Segment::prepare() {
  if (scene_.sweep != nullptr) {
    for (const PlacedPart& p : start_) orientations_.number_of(p.pose.q);
    relations_ =
        std::make_unique<blocking::Relations>(*scene_.sweep, scene_.directions, orientations_, scene_.context.executor);
  }
  for (const ObjectiveItem& item : scene_.query.objective.items) {
    items_.push_back({&item, item.check->traits(), {}});
    exact_ = exact_ && !items_.back().traits.reads_path && !items_.back().traits.estimates;
  }
}

/// Parts that are in no unit yet: what is kept together is one.
void Segment::add_kept_units() {
  const std::vector<PartId> kept = kept_sets(scene_.query.assembly.parts.size(), scene_.query.constraints);
  std::map<PartId, std::vector<PlacedPart>> left;
  for (const PlacedPart& p : start_)
    if (!unit_of_.contains(p.part)) left[kept[p.part]].push_back(p);
  for (auto& [first, parts] : left) {
    for (const PlacedPart& p : parts) unit_of_[p.part] = parts_.size();
    parts_.push_back(std::move(parts));
  }
  stay_ = in_group_ = UnitSet(units());
  needs_gone_.assign(units(), UnitSet(units()));
  for (const auto& [first, then] : scene_.query.constraints.before)
    if (unit_of_.contains(first) && unit_of_.contains(then) && unit_of_[first] != unit_of_[then])
      needs_gone_[unit_of_[then]].insert(unit_of_[first]);
}

/// A unit leaves as a whole: what a step of the first plan takes out, or what is left and is kept together.
void Segment::add_units(const std::vector<const Removal*>& planned) {
  for (const Removal* removal : planned) {
    std::vector<PlacedPart> parts;
    for (const PlacedPart& p : start_)
      if (contains(removal->parts, p.part)) parts.push_back(p);
    for (const PlacedPart& p : parts) unit_of_[p.part] = parts_.size();
    parts_.push_back(std::move(parts));
  }
  const std::size_t leaving = parts_.size();
  add_kept_units();
  one_left_ = units() == leaving + 1;
  for (std::size_t u = leaving; u < units(); ++u) stay_.insert(u);
}

void Segment::add_moves(const std::vector<const Removal*>& planned) {
  UnitSet present(units(), true);
  for (std::size_t u = 0; u < planned.size(); ++u) {
    present.erase(u);
    add_planned(planned[u], present);
    if (scene_.sweep != nullptr && is_straight(planned[u]->attempt->path())) add_straight(u);
  }
  if (one_left_ && scene_.sweep != nullptr) add_straight(units() - 1);
}

/// `present`: what the step leaves behind.
void Segment::add_planned(const Removal* planned, const UnitSet& present) {
  Move move{{planned->parts, {}, planned, insertion_of(scene_.query.assembly, *planned)},
            UnitSet(units()),
            present,
            UnitSet(units()),
            UnitSet(units()),
            {},
            {},
            0};
  for (const PartId id : planned->parts) move.units.insert(unit_of_.at(id));
  // A straight step is found again among the straight motions, with a path as long as it has to be.
  if (scene_.sweep != nullptr && is_straight(planned->attempt->path()))
    for (std::size_t d = 0; d < scene_.directions.all.size(); ++d)
      if (scene_.directions.all[d].dot(-move.motion.insertion) > 1 - 1e-12) move.motion.direction = d;
  add(std::move(move));
}

void Segment::add_straight(std::size_t unit) {
  const std::vector<PartId>& base = scene_.query.constraints.base;
  std::set<std::size_t> own(scene_.everywhere.begin(), scene_.everywhere.end());
  for (const PlacedPart& p : parts_[unit]) {
    if (contains(base, p.part)) return;
    const auto& of_part = scene_.directions.of_part[p.part];
    own.insert(of_part.begin(), of_part.end());
  }
  for (const std::size_t d : own) {
    const bool there = std::any_of(moves_.begin(), moves_.end(), [&](const Move& m) {
      return m.units.contains(unit) && m.units.size() == 1 && m.motion.direction == d;
    });
    if (there) continue;
    Move move{{ids_of(parts_[unit]), d, nullptr, -scene_.directions.all[d]},
              UnitSet(units()),
              UnitSet(units()),
              UnitSet(units()),
              UnitSet(units()),
              {},
              {},
              0};
    move.units.insert(unit);
    add(std::move(move));
  }
}

void Segment::add(Move move) {
  const auto known =
      std::find_if(courses_.begin(), courses_.end(), [&](const Vector3d& c) { return same(c, move.motion.insertion); });
  move.course = static_cast<std::size_t>(known - courses_.begin());
  if (known == courses_.end()) courses_.push_back(move.motion.insertion);
  moves_.push_back(std::move(move));
}

void Segment::add_variants() {
  of_unit_.resize(units());
  for (std::size_t m = 0; m < moves_.size(); ++m) {
    std::size_t unit = 0;
    while (!moves_[m].units.contains(unit)) ++unit;
    for (std::size_t up = 0; up < scene_.ups.size(); ++up) {
      of_unit_[unit].push_back(variants_.size());
      class_of_.push_back(std::min(moves_[m].course * scene_.ups.size() + up, kClasses));
      if (moves_[m].motion.planned != nullptr && scene_.ups[up] == moves_[m].motion.planned->up)
        planned_.push_back(variants_.size());
      variants_.push_back({m, up});
    }
  }
}

/// What a check says that reads nothing but the motion, and of the step before nothing but direction and orientation,
/// can be tabulated.
void Segment::find_bounds() {
  least_.assign(variants_.size(), 0);
  preference_.clear();
  for (VariantId v = 0; v < variants_.size(); ++v)
    preference_.push_back(preference_of(motion(v).insertion, up(v).value_or(scene_.query.objective.up)));
  change_ = std::numeric_limits<double>::infinity();
  std::map<std::size_t, VariantId> representatives;
  for (VariantId v = 0; v < variants_.size(); ++v) representatives.try_emplace(class_of_[v], v);
  std::vector<const Item*> fixed;
  for (const Item& item : items_)
    if (!item.traits.reads_present && !item.traits.reads_path && !item.traits.remembers_shape) fixed.push_back(&item);
  constexpr std::size_t kMostQuestions = 100000;
  const bool clear = courses_.size() * scene_.ups.size() <= kClasses && !fixed.empty() &&
                     variants_.size() * (representatives.size() + 1) <= kMostQuestions;
  for (VariantId v = 0; clear && v < variants_.size(); ++v) {
    const UnitSet none(units());
    const auto sum = [&](VariantId previous) {
      double all = 0;
      for (const Item* item : fixed) all += item->item->weight * judge(*item, v, none, previous);
      return all;
    };
    double like = sum(kNone), other = std::numeric_limits<double>::infinity();
    for (const auto& [key, previous] : representatives)
      (key == class_of_[v] ? like : other) = std::min(key == class_of_[v] ? like : other, sum(previous));
    least_[v] = std::min(like, other);
    change_ = std::min(change_, other - least_[v]);
  }
  if (!clear || !(change_ < std::numeric_limits<double>::infinity())) change_ = 0;
  if (clear) return;
  for (const Item* item : fixed)
    for (VariantId v = 0; v < variants_.size(); ++v)
      if (!item->traits.remembers_direction && !item->traits.remembers_orientation)
        least_[v] += item->item->weight * judge(*item, v, UnitSet(units()), kNone);
}

Task Segment::task() const {
  Task task;
  task.start = UnitSet(units(), true);
  task.end = one_left_ ? End::one_left : End::exactly;
  if (!one_left_) task.goal = stay_;
  return task;
}

std::vector<VariantId> Segment::as_planned() const { return planned_; }

bool Segment::may_leave(VariantId v, const UnitSet& present) {
  Move& move = moves_[variants_[v].move];
  if (move.blocking.intersects(present) || move.unknown.intersects(present)) return false;
  bool held = false;
  move.units.each([&](std::size_t u) {
    held = held || (!needs_gone_[u].empty() && needs_gone_[u].intersects(present - move.units));
  });
  if (held) return false;
  if (!move.knows_far && relations_ && move.motion.direction && move.units.size() == 1) {
    // One pass over numbers for what Relations::far() would say of most pairs, one by one.
    const std::size_t d = *move.motion.direction;
    extents_.resize(scene_.directions.all.size());
    if (extents_[d].empty()) {
      extents_[d].resize(units());
      for (std::size_t u = 0; u < units(); ++u) {
        blocking::Relations::Extents all;
        for (const PlacedPart& p : parts_[u])
          all.extend(relations_->extents_at(p.part, d, orientations_.number_of(p.pose.q), p.pose.t));
        extents_[d].set(u, all);
      }
    }
    std::size_t own = 0;
    while (!move.units.contains(own)) ++own;
    const blocking::Relations::Extents reach = extents_[d].reach_of(own);
    for (std::size_t u = 0; u < units(); ++u)
      if (u != own && !extents_[d].may_meet(reach, u) && !move.blocking.contains(u)) move.free.insert(u);
    move.knows_far = true;
  }
  // is_in_the_way() adds no unit to `free` but the one that is asked about.
  return UnitSet::all_of_rest(present, move.free, move.units, [&](std::size_t u) { return !is_in_the_way(move, u); });
}

const UnitSet& Segment::blocking(VariantId v) {
  Move& move = moves_[variants_[v].move];
  const UnitSet open = UnitSet(units(), true) - move.free - move.blocking - move.units;
  open.each([&](std::size_t u) { is_in_the_way(move, u); });
  move.needs = move.blocking;
  move.units.each([&](std::size_t u) { move.needs |= needs_gone_[u]; });
  move.needs -= move.units;
  return move.needs;
}

/// Without effort left, what is not known is in the way.
bool Segment::is_in_the_way(Move& move, std::size_t unit) {
  bool blocks = false, spent = false;
  if (scene_.sweep == nullptr) {
    blocks = true;
  } else {
    if (!move.motion.direction && move.path.empty()) extend(move);
    move.units.each([&](std::size_t own) {
      for (const PlacedPart& a : parts_[own])
        for (const PlacedPart& b : parts_[unit]) {
          if (blocks || spent) return;
          if (move.motion.direction) {
            const blocking::Pair pair{a.part,
                                      b.part,
                                      *move.motion.direction,
                                      a.pose.t - b.pose.t,
                                      orientations_.number_of(a.pose.q),
                                      orientations_.number_of(b.pose.q)};
            if (!relations_->far(pair)) {
              spent = !relations_->known(pair) && !scene_.sweeps.spend();
              if (!spent) blocks = relations_->blocks(pair);
            }
          } else {
            spent = !scene_.sweeps.spend();
            const auto column = std::find(move.motion.parts.begin(), move.motion.parts.end(), a.part);
            std::vector<Pose> path;
            for (const auto& poses : move.path)
              path.push_back(poses[static_cast<std::size_t>(column - move.motion.parts.begin())]);
            if (!spent) blocks = !scene_.sweep->passes(a.part, b.part, b.pose, path);
          }
        }
    });
  }
  unsure_ = unsure_ || spent;
  if (spent) {  // sweeps that are spent do not come back: it is not asked about again
    move.unknown.insert(unit);
    return true;
  }
  (blocks ? move.blocking : move.free).insert(unit);
  return blocks;
}

/// Goes on along the last stretch until it is apart from everything.
void Segment::extend(Move& move) {
  move.path = move.motion.planned->attempt->path();
  std::vector<PlacedPart> at_end, others;
  for (std::size_t i = 0; i < move.motion.parts.size(); ++i)
    at_end.push_back({move.motion.parts[i], move.path.back()[i]});
  for (const PlacedPart& p : start_)
    if (!contains(move.motion.parts, p.part)) others.push_back(p);
  if (move.motion.insertion.isZero()) return;
  double most = 0;
  for (const PlacedPart& p : start_) most += scene_.query.assembly.parts[p.part].mesh->box().size().norm();
  const double length = scene_.sweep->distance_apart(at_end, others, -move.motion.insertion, most);
  if (length <= 0) return;
  for (PlacedPart& p : at_end) p.pose.t -= (length + scene_.sweep->tolerance()) * move.motion.insertion;
  move.path.emplace_back();
  for (const PlacedPart& p : at_end) move.path.back().push_back(p.pose);
}

void Segment::forbid(VariantId v, const std::vector<PartId>& blocked_by) {
  Move& move = moves_[variants_[v].move];
  UnitSet units(this->units());
  for (const PartId id : blocked_by)
    if (const auto unit = unit_of_.find(id); unit != unit_of_.end() && !move.units.contains(unit->second))
      units.insert(unit->second);
  if (units.size() == 0) units = UnitSet(this->units(), true) - move.units;
  move.free = move.free - units;
  move.blocking |= units;
}

}  // namespace dismantle::order
