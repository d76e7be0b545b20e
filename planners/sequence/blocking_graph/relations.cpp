#include "blocking_graph/relations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

Relations::Relations(const PairSweep& sweep, const Directions& directions, const Orientations& orientations,
                     std::shared_ptr<Executor> executor)
    : directions_(directions),
      sweep_(sweep),
      grid_(1e-4 * sweep.tolerance()),
      shadows_(directions.all.size()),
      orientations_(orientations),
      executor_(std::move(executor)),
      blocks_ahead_(executor_, Executor::Priority::speculative, [](bool blocked) { return blocked; }) {
  for (const auto& d : directions.all) {
    const Vec3 across = d.unitOrthogonal();
    Eigen::Matrix3d frame;
    frame.row(0) = d;
    frame.row(1) = across;
    frame.row(2) = d.cross(across);
    frames_.push_back(frame);
  }
}

Relations::Shadow Relations::scene(PartId part, std::size_t direction, const Eigen::Matrix3d& turn) const {
  Shadow s;
  for (int k = 0; k < 3; ++k) s.lo[k] = std::numeric_limits<double>::infinity(), s.hi[k] = -s.lo[k];
  const Eigen::Matrix3d frame = frames_[direction] * turn;
  for (const Vec3& v : sweep_.hull(part)) {
    const Vec3 p = frame * v;
    for (int k = 0; k < 3; ++k) s.lo[k] = std::min(s.lo[k], p[k]), s.hi[k] = std::max(s.hi[k], p[k]);
  }
  return s;
}

const Relations::Shadow& Relations::shadow(PartId part, std::size_t direction, std::size_t turn) const {
  if (turn != 0) {
    const auto [entry, is_new] = rotated_shadows_.try_emplace({turn, direction, part});
    if (is_new) entry->second = scene(part, direction, orientations_[turn].toRotationMatrix());
    return entry->second;
  }
  auto& list = shadows_[direction];
  if (list.empty())
    for (PartId id = 0; id < sweep_.parts(); ++id) list.push_back(scene(id, direction, Eigen::Matrix3d::Identity()));
  return list[part];
}

std::pair<double, double> Relations::extent(PartId part, std::size_t direction, std::size_t turn) const {
  const Shadow& s = shadow(part, direction, turn);
  return {s.lo[0], s.hi[0]};
}

/// "i along d past j" and "j along -d past i" are one question. Budgets and rounded offsets could make their answers
/// differ, so only one form of the question is ever computed.
Pair Relations::canonical(Pair p) const {
  if (p.moving > p.fixed) {
    std::swap(p.moving, p.fixed);
    std::swap(p.orientation_moving, p.orientation_fixed);
    p.offset = -p.offset;
    p.direction = Directions::opposite(p.direction);
  }
  for (double& x : p.offset) x = grid_ * std::round(x / grid_) + 0.0;
  return p;
}

Relations::Key Relations::key_of(const Pair& pair) const {
  const Pair p = canonical(pair);
  const auto grid = [this](double x) { return std::lround(x / grid_); };
  return {p.moving,
          p.fixed,
          p.direction,
          grid(p.offset.x()),
          grid(p.offset.y()),
          grid(p.offset.z()),
          p.orientation_moving,
          p.orientation_fixed};
}

bool Relations::known(const Pair& pair) const { return far(pair) || blocks_.contains(key_of(pair)); }

bool Relations::known_to_block(const Pair& pair) const {
  if (far(pair)) return false;
  const auto found = blocks_.find(key_of(pair));
  return found != blocks_.end() && found->second;
}

double Relations::distance_past(const Pair& p) const {
  return shadow(p.fixed, p.direction, p.orientation_fixed).hi[0] -
         shadow(p.moving, p.direction, p.orientation_moving).lo[0] - p.offset.dot(directions_.all[p.direction]);
}

bool Relations::far(const Pair& p) const {
  const Shadow &a = shadow(p.moving, p.direction, p.orientation_moving),
               &b = shadow(p.fixed, p.direction, p.orientation_fixed);
  const Vec3 o = frames_[p.direction] * p.offset;
  if (b.hi[0] - a.lo[0] - o[0] <= 0) return true;  // past it already
  for (int k = 1; k < 3; ++k)
    if (a.lo[k] + o[k] >= b.hi[k] || a.hi[k] + o[k] <= b.lo[k]) return true;
  return false;
}

/// The computation of blocks().
Relations::Ahead::Request Relations::request(const Pair& pair) const {
  const Pair p = canonical(pair);
  const Pose begin{p.offset, orientations_[p.orientation_moving]};
  Pose end = begin;
  // Ends a tenth of the tolerance past the fixed part, so that the two do not just touch at the end.
  end.t += (distance_past(p) + 0.1 * sweep_.tolerance()) * directions_.all[p.direction];
  const Pose fixed_at{Vec3::Zero(), orientations_[p.orientation_fixed]};
  return {key_of(pair), [this, p, fixed_at, path = std::vector<Pose>{begin, end}](const RunContext&) {
            return !sweep_.passes(p.moving, p.fixed, fixed_at, path);
          }};
}

bool Relations::blocks(const Pair& pair) {
  if (far(pair)) return false;
  const Key key = key_of(pair);
  const auto found = blocks_.find(key);
  if (found != blocks_.end()) return found->second;
  const bool blocked = blocks_ahead_.get(key, request(pair).compute, {});
  return blocks_.emplace(key, blocked).first->second;
}

void Relations::compute(std::span<const Pair> pairs) {
  std::vector<Ahead::Request> unknown;
  for (const Pair& pair : pairs)
    if (!known(pair)) unknown.push_back(request(pair));
  const auto by_key = [](const auto& a, const auto& b) { return a.key < b.key; };
  std::sort(unknown.begin(), unknown.end(), by_key);
  unknown.erase(
      std::unique(unknown.begin(), unknown.end(), [](const auto& a, const auto& b) { return a.key == b.key; }),
      unknown.end());
  std::vector<char> blocked(unknown.size());
  parallel_for(
      unknown.size(), executor_.get(),
      [&](std::size_t k) { blocked[k] = blocks_ahead_.get(unknown[k].key, unknown[k].compute, {}); },
      [] { return false; });
  for (std::size_t k = 0; k < unknown.size(); ++k) blocks_.emplace(unknown[k].key, blocked[k] != 0);
}

void Relations::hint(const std::vector<std::vector<Pair>>& lists) {
  std::deque<Ahead::Sequence> sequences;
  for (const auto& list : lists) {
    Ahead::Sequence sequence;
    for (const Pair& pair : list)
      if (!known(pair)) sequence.push_back(request(pair));
    if (!sequence.empty()) sequences.push_back(std::move(sequence));
  }
  blocks_ahead_.prefetch(std::move(sequences), {});
}

}  // namespace dismantle::blocking
