#include <algorithm>
#include <limits>
#include <utility>

#include "best_order/segment.h"

namespace dismantle::order {

using Eigen::Vector3d;

double cost_by(const ObjectiveItem& item, const StepQuestion& question, Objective::Ask ask, const RunContext& context) {
  try {
    const StepVerdict verdict = ((*item.check).*ask)(question, context);
    if (!(verdict.cost >= 0)) throw CheckFailed("its cost is not a number from 0 on");
    return item.require && !verdict.allowed ? kForbidden : verdict.cost;
  } catch (const std::exception& e) {
    throw CheckFailed("'" + item.id + "': " + e.what());
  }
}

double Segment::preference(const std::vector<VariantId>& order) const {
  double sum = 0;
  for (const VariantId v : order) sum += preference_[v];
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
  double sum = preference_[v];
  for (Item& item : items_) {
    const bool reads_rest = item.traits.reads_present || item.traits.reads_path;
    CostKey key{v, memory(item, previous), reads_rest ? rest : UnitSet()};
    const auto known = item.known.find(key);
    const double cost = known != item.known.end()
                            ? known->second
                            : item.known.emplace(std::move(key), judge(item, v, rest, previous)).first->second;
    sum += cost == 0 ? 0 : item.item->weight * cost;
    if (cost == kForbidden) return kForbidden;
  }
  return sum;
}

double Segment::verdict(VariantId v, const UnitSet& rest) {
  double sum = cost(v, rest, kNone);
  for (const Item& item : items_) {
    if (!item.traits.estimates || !(sum < kForbidden)) continue;
    sum += item.item->weight * (judge(item, v, rest, kNone, &StepCheck::judge) - judge(item, v, rest, kNone));
  }
  return sum;
}

double Segment::judge(const Item& item, VariantId v, const UnitSet& rest, VariantId previous, Objective::Ask ask) {
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
  if (previous == kNone) return cost_by(*item.item, question, ask, scene_.context);
  const Move& earlier = moves_[variants_[previous].move];
  const std::vector<PlacedPart> put_in = moving_of(earlier);
  const StepQuestion before{scene_.query.assembly,
                            put_in,
                            nothing,
                            earlier.motion.insertion,
                            nullptr,
                            scene_.ups[variants_[previous].up].value_or(drawn),
                            nullptr};
  StepQuestion with = question;
  with.previous = &before;
  return cost_by(*item.item, with, ask, scene_.context);
}

const std::vector<PlacedPart>& Segment::present(const UnitSet& rest) {
  if (!(rest == present_of_)) {
    present_of_ = rest;
    present_.clear();
    if (with_unit_.empty()) {
      for (std::size_t u = 0; u < units(); ++u)
        for (const PlacedPart& p : parts_[u]) with_unit_.emplace_back(p, u);
      std::sort(with_unit_.begin(), with_unit_.end(),
                [](const auto& a, const auto& b) { return a.first.part < b.first.part; });
    }
    for (const auto& [part, unit] : with_unit_)
      if (rest.contains(unit)) present_.push_back(part);
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
