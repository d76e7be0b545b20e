// Parts that are turned where they are, and stay turned: what a latch or a bayonet asks for.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kAxes = 2;                        // of one part
constexpr int kStops = 24;                              // in a full turn
constexpr int kHalvings = 4;                            // of the last arc, to find where it meets something
constexpr std::size_t kMostQuestions = 300;             // to the judge, for one group as it stands
constexpr double kArc = 2 * std::numbers::pi / kStops;  // rad

Pose turned(const Pose& pose, const TurningAxis& axis, double angle) {
  const Eigen::Vector3d point = pose * axis.point, direction = pose.q * axis.direction;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, direction));
  return {point + q * (pose.t - point), (q * pose.q).normalized()};
}

}  // namespace

/// Does a part on its short arc pass another? It depends on these two alone, and is asked again whenever somebody else
/// has left.
bool TakingApart::arc_passes(PartId part, const Pose& from, const Pose& to, PartId still) {
  const Pose& there = poses_[still];
  std::vector<double> key{static_cast<double>(part), static_cast<double>(still)};
  for (const Pose* p : {&from, &to, &there}) {
    key.insert(key.end(), p->t.begin(), p->t.end());
    key.insert(key.end(), p->q.coeffs().begin(), p->q.coeffs().end());
  }
  if (const auto known = arcs_.find(key); known != arcs_.end()) return known->second;
  const bool passes = oracle_.judge()->passes(part, still, there, {from, to});
  return arcs_.emplace(std::move(key), passes).first->second;
}

/// May the unit go from one pose to the other, which is a short arc away?
bool TakingApart::turns_clear(const Group& group, UnitId unit, const Pose& from, const Pose& to) {
  const PartId part = units_[unit].front();
  for (const UnitId other : group.units) {
    if (other == unit) continue;
    for (const PartId id : units_[other]) {
      ++turn_questions_;
      if (!arc_passes(part, from, to, id)) return false;
    }
  }
  return true;
}

/// Who else could leave, and along which direction, now that `unit` stands as poses_ says? Only those are asked whom it
/// was in the way of. Whether turning frees the part itself is a question for the path planner.
std::optional<std::pair<TakingApart::UnitId, std::size_t>> TakingApart::freed_by(const Group& group, UnitId unit) {
  for (const UnitId u : group.units) {
    if (u == unit || !may_leave(group, {u})) continue;
    for (const std::size_t d : directions_of(group, u)) {
      if (stop() || turn_questions_ > kMostQuestions) return std::nullopt;
      const auto watched = watched_[u].find(d);
      if (watched == watched_[u].end() || watched->second != unit) continue;
      // Another that is in the way holds whatever this one does; if it is this one again, it was before.
      watched_[u].erase(watched);
      for (auto open = open_questions(group, u, d); !open.empty(); open = open_questions(group, u, d)) {
        ++turn_questions_;
        relations_->blocks(open.front());
      }
      if (!watched_[u].contains(d)) return std::pair(u, d);
    }
  }
  return std::nullopt;
}

/// Puts the turn to the judge, and leaves the part there.
bool TakingApart::turns_to(Group& group, UnitId unit, const Path& way) {
  Attempt attempt = question(group, {unit});
  attempt.part_way = true;
  const AttemptResult& answer = oracle_.propose(attempt, way, context_);
  if (!is_success(answer.result.outcome())) return false;
  book(group, {unit}, attempt, answer);
  ++counts_["turns"];
  return true;
}

bool TakingApart::turn(Group& group, UnitId unit, const TurningAxis& axis) {
  const PartId part = units_[unit].front();
  const Pose start = poses_[part];
  const std::size_t start_turn = turn_[part];
  for (const int sense : {1, -1}) {
    Path way{{start}};
    bool met = false;
    for (int k = 1; k < kStops && !met; ++k) {
      if (stop() || turn_questions_ > kMostQuestions) return false;
      Pose next = turned(start, axis, sense * k * kArc);
      if (!turns_clear(group, unit, way.back().front(), next)) {
        met = true;  // as far as it goes
        double clear = 0, blocked = kArc;
        for (int h = 0; h < kHalvings; ++h) {
          const double middle = 0.5 * (clear + blocked);
          const Pose there = turned(start, axis, sense * ((k - 1) * kArc + middle));
          (turns_clear(group, unit, way.back().front(), there) ? clear : blocked) = middle;
        }
        if (clear < 0.1 * kArc) break;
        next = turned(start, axis, sense * ((k - 1) * kArc + clear));
      }
      way.push_back({next});
      poses_[part] = next;
      turn_[part] = relations_->turn(next.q);
      const auto freed =
          vain_.contains({group.units, turn_[part] * units_.size() + unit}) ? std::nullopt : freed_by(group, unit);
      const std::size_t there = turn_[part];
      poses_[part] = start;
      turn_[part] = start_turn;
      if (!freed) continue;
      vain_.insert({group.units, there * units_.size() + unit});
      if (!turns_to(group, unit, way)) break;
      leave(group, {freed->first}, freed->second);  // if the judge refuses that after all, there is a next try
      return true;
    }
    if (!met) break;  // all the way round: the other sense has nothing to add
  }
  return false;
}

/// Nobody is free, but somebody may be when another part is turned.
bool TakingApart::turn(Group& group) {
  turn_questions_ = 0;
  const auto& base = oracle_.constraints().base;
  for (const UnitId u : std::vector<UnitId>(group.units)) {
    if (units_[u].size() > 1) continue;
    const PartId part = units_[u].front();
    if (std::find(base.begin(), base.end(), part) != base.end()) continue;
    const auto [entry, is_new] = axes_.try_emplace(part);
    if (is_new) entry->second = turning_axes(*assembly_.parts[part].mesh, kAxes);
    for (const TurningAxis& axis : entry->second)
      if (turn(group, u, axis)) return true;
  }
  return false;
}

}  // namespace dismantle::blocking
