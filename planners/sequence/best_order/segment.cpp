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

constexpr double kPreference = 1e-7;  // of a direction, by one degree; far below all costs of checks
constexpr std::size_t kClasses = 63;  // of variants; the last one is for all others

bool same(const Vector3d& a, const Vector3d& b) { return a.dot(b) > geometry::kSameDirection || (a.isZero() && b.isZero()); }

Vector3d insertion_of(const Assembly& assembly, const Removal& removal) {
  const AttemptResult& answer = *removal.attempt;
  return Operation(assembly, answer.attempt.moving, {}, answer.path(), Vector3d::UnitZ()).question().direction;
}

/// Is the path a translation along one line?
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

}  // namespace

Segment::Segment(OrderScene& scene, std::vector<PlacedPart> start, std::vector<const Removal*> planned)
    : scene_(scene), start_(std::move(start)) {
  if (scene_.sweep != nullptr) {
    for (const PlacedPart& p : start_) orientations_.number_of(p.pose.q);
    relations_ = std::make_unique<blocking::Relations>(*scene_.sweep, scene_.directions, orientations_,
                                                       scene_.context.executor);
  }
  for (const ObjectiveItem& item : scene_.query.objective.items) {
    items_.push_back({&item, item.check->traits(), {}});
    exact_ = exact_ && !items_.back().traits.reads_path && !items_.back().traits.estimates;
  }
  add_units(planned);
  add_moves(planned);
  add_variants();
  find_bounds();
}

/// A unit leaves as a whole: what a step of the first plan takes out, or what is left and is kept together.
void Segment::add_units(const std::vector<const Removal*>& planned) {
  const std::vector<PartId> kept = kept_sets(scene_.query.assembly.parts.size(), scene_.query.constraints);
  const auto add_unit = [&](std::vector<PlacedPart> parts) {
    for (const PlacedPart& p : parts) unit_of_[p.part] = parts_.size();
    parts_.push_back(std::move(parts));
  };
  for (const Removal* removal : planned) {
    std::vector<PlacedPart> parts;
    for (const PlacedPart& p : start_)
      if (contains(removal->parts, p.part)) parts.push_back(p);
    add_unit(std::move(parts));
  }
  const std::size_t leaving = parts_.size();
  std::map<PartId, std::vector<PlacedPart>> left;
  for (const PlacedPart& p : start_)
    if (!unit_of_.contains(p.part)) left[kept[p.part]].push_back(p);
  for (auto& [first, parts] : left) add_unit(std::move(parts));
  stay_ = UnitSet(units());
  one_left_ = units() == leaving + 1;
  for (std::size_t u = leaving; u < units(); ++u) stay_.insert(u);
  needs_gone_.assign(units(), UnitSet(units()));
  for (const auto& [first, then] : scene_.query.constraints.before)
    if (unit_of_.contains(first) && unit_of_.contains(then) && unit_of_[first] != unit_of_[then])
      needs_gone_[unit_of_[then]].insert(unit_of_[first]);
}

void Segment::add_moves(const std::vector<const Removal*>& planned) {
  UnitSet present(units(), true);
  for (std::size_t u = 0; u < planned.size(); ++u) {
    present.erase(u);
    Move move{{planned[u]->parts, {}, planned[u], insertion_of(scene_.query.assembly, *planned[u])}, UnitSet(units()),
              present, UnitSet(units()), {}, 0};
    move.units.insert(u);
    // A straight step is found again among the straight motions, with a path as long as it has to be.
    if (scene_.sweep != nullptr && is_straight(planned[u]->attempt->path()))
      for (std::size_t d = 0; d < scene_.directions.all.size(); ++d)
        if (scene_.directions.all[d].dot(-move.motion.insertion) > 1 - 1e-12) move.motion.direction = d;
    add(std::move(move));
    if (scene_.sweep != nullptr && is_straight(planned[u]->attempt->path())) add_straight(u);
  }
  if (one_left_ && scene_.sweep != nullptr) add_straight(units() - 1);
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
      return m.units.contains(unit) && m.motion.direction == d;
    });
    if (there) continue;
    Move move{{ids_of(parts_[unit]), d, nullptr, -scene_.directions.all[d]}, UnitSet(units()), UnitSet(units()),
              UnitSet(units()), {}, 0};
    move.units.insert(unit);
    add(std::move(move));
  }
}

void Segment::add(Move move) {
  const auto known = std::find_if(courses_.begin(), courses_.end(),
                                  [&](const Vector3d& c) { return same(c, move.motion.insertion); });
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
  if (move.blocking.intersects(present)) return false;
  bool held = false;
  move.units.each([&](std::size_t u) { held = held || needs_gone_[u].intersects(present - move.units); });
  if (held) return false;
  const UnitSet open = present - move.free - move.units;
  bool free = true;
  open.each([&](std::size_t u) { free = free && !is_in_the_way(move, u); });
  return free;
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
  if (spent) return true;
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

double Segment::preference(VariantId v) const {
  const Vector3d& d = moves_[variants_[v].move].motion.insertion;
  if (d.isZero()) return 0;
  const double along = d.cwiseAbs().maxCoeff(), upwards = d.dot(up(v).value_or(scene_.query.objective.up));
  constexpr double kAlong = 0.9998, kSteep = 0.7;  // within 1, and 45, degrees
  return kPreference * ((along > kAlong ? 0 : 4) + (upwards > kSteep ? 2 : upwards > -kSteep ? 1 : 0));
}

double Segment::preference(const std::vector<VariantId>& order) const {
  double sum = 0;
  for (const VariantId v : order) sum += preference(v);
  return sum;
}

double Segment::most_preference() const { return 6 * kPreference * static_cast<double>(units()); }

std::size_t Segment::memory(const Item& item, VariantId v) const {
  if (v == kNone) return 0;
  const Variant& variant = variants_[v];
  std::size_t key = 1;
  key = key * (courses_.size() + 1) + (item.traits.remembers_direction ? 1 + moves_[variant.move].course : 0);
  key = key * (scene_.ups.size() + 1) + (item.traits.remembers_orientation ? 1 + variant.up : 0);
  return key * (moves_.size() + 1) + (item.traits.remembers_shape ? 1 + variant.move : 0);
}

double Segment::cost(VariantId v, const UnitSet& rest, VariantId previous) {
  double sum = preference(v);
  for (Item& item : items_) {
    const bool reads_rest = item.traits.reads_present || item.traits.reads_path;
    CostKey key{v, memory(item, previous), reads_rest ? rest : UnitSet()};
    const auto known = item.known.find(key);
    const double cost = known != item.known.end() ? known->second
                                                   : item.known.emplace(std::move(key), judge(item, v, rest, previous)).first->second;
    sum += cost == 0 ? 0 : item.item->weight * cost;
    if (cost == kForbidden) return kForbidden;
  }
  return sum;
}

double Segment::judge(const Item& item, VariantId v, const UnitSet& rest, VariantId previous) {
  const Move& move = moves_[variants_[v].move];
  const auto moving_of = [&](const Move& m) {
    std::vector<PlacedPart> parts;
    m.units.each([&](std::size_t u) { parts.insert(parts.end(), parts_[u].begin(), parts_[u].end()); });
    return parts;
  };
  const Vector3d& drawn = scene_.query.objective.up;
  const std::vector<PlacedPart> moving = moving_of(move);
  Trace insertion;
  if (item.traits.reads_path) {
    if (move.motion.direction) {
      const Vector3d out = length_out(move, rest) * scene_.directions.all[*move.motion.direction];
      insertion.resize(2);
      for (const PlacedPart& p : moving) {
        insertion[0].push_back({p.pose.t + out, p.pose.q});
        insertion[1].push_back(p.pose);
      }
    } else {
      insertion.assign(move.motion.planned->attempt->path().rbegin(), move.motion.planned->attempt->path().rend());
    }
  }
  static const std::vector<PlacedPart> nothing;
  const StepQuestion question{scene_.query.assembly,
                              moving,
                              item.traits.reads_present ? present(rest) : nothing,
                              move.motion.insertion,
                              insertion.empty() ? nullptr : &insertion,
                              scene_.ups[variants_[v].up].value_or(drawn),
                              nullptr};
  try {
    StepVerdict verdict;
    if (previous == kNone) {
      verdict = item.item->check->estimate(question, scene_.context);
    } else {
      const Move& earlier = moves_[variants_[previous].move];
      const std::vector<PlacedPart> put_in = moving_of(earlier);
      const StepQuestion before{scene_.query.assembly,    put_in,  nothing,
                                earlier.motion.insertion, nullptr, scene_.ups[variants_[previous].up].value_or(drawn),
                                nullptr};
      StepQuestion with = question;
      with.previous = &before;
      verdict = item.item->check->estimate(with, scene_.context);
    }
    if (!(verdict.cost >= 0)) throw CheckFailed("its cost is not a number from 0 on");
    return item.item->require && !verdict.allowed ? kForbidden : verdict.cost;
  } catch (const std::exception& e) {
    throw CheckFailed("'" + item.item->id + "': " + e.what());
  }
}

const std::vector<PlacedPart>& Segment::present(const UnitSet& rest) {
  if (!(rest == present_of_)) {
    present_of_ = rest;
    present_.clear();
    rest.each([&](std::size_t u) { present_.insert(present_.end(), parts_[u].begin(), parts_[u].end()); });
    std::sort(present_.begin(), present_.end(), [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; });
  }
  return present_;
}

/// By boxes along the direction: an estimate from above of the length of the path in the plan.
double Segment::length_out(const Move& move, const UnitSet& rest) {
  const std::size_t d = *move.motion.direction;
  const Vector3d& axis = scene_.directions.all[d];
  double own = std::numeric_limits<double>::infinity(), others = -own;
  const auto extent = [&](const PlacedPart& p) {
    const auto [lo, hi] = relations_->extent(p.part, d, orientations_.number_of(p.pose.q));
    return std::pair(lo + p.pose.t.dot(axis), hi + p.pose.t.dot(axis));
  };
  move.units.each([&](std::size_t u) {
    for (const PlacedPart& p : parts_[u]) own = std::min(own, extent(p).first);
  });
  rest.each([&](std::size_t u) {
    for (const PlacedPart& p : parts_[u]) others = std::max(others, extent(p).second);
  });
  return std::max(0.0, others - own);
}

}  // namespace dismantle::order
