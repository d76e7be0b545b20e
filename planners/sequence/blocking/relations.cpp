#include "blocking/relations.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "dismantle/geometry/hull.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kGrid = 1e-6;    // offsets that differ by less are the same
constexpr double kBeyond = 1e-3;  // how far past: the judge's margins have room

}  // namespace

Relations::Relations(const Assembly& assembly, const Verifier& judge, const Directions& directions)
    : assembly_(assembly), judge_(judge), directions_(directions), shadows_(directions.all.size()) {
  for (const auto& part : assembly.parts) hulls_.push_back(hull_corners(part.mesh->vertices));
  for (const auto& d : directions.all) {
    const Vec3 across = d.unitOrthogonal();
    Eigen::Matrix3d frame;
    frame.row(0) = d;
    frame.row(1) = across;
    frame.row(2) = d.cross(across);
    frames_.push_back(frame);
  }
}

Relations::Shadow Relations::cast(PartId part, std::size_t direction, const Eigen::Matrix3d& turn) const {
  Shadow s;
  for (int k = 0; k < 3; ++k) s.lo[k] = std::numeric_limits<double>::infinity(), s.hi[k] = -s.lo[k];
  const Eigen::Matrix3d frame = frames_[direction] * turn;
  for (const Vec3& v : hulls_[part]) {
    const Vec3 p = frame * v;
    for (int k = 0; k < 3; ++k) s.lo[k] = std::min(s.lo[k], p[k]), s.hi[k] = std::max(s.hi[k], p[k]);
  }
  return s;
}

const Relations::Shadow& Relations::shadow(PartId part, std::size_t direction, std::size_t turn) const {
  if (turn != 0) {
    const auto [entry, is_new] = turned_shadows_.try_emplace({turn, direction, part});
    if (is_new) entry->second = cast(part, direction, turns_[turn].toRotationMatrix());
    return entry->second;
  }
  auto& list = shadows_[direction];
  if (list.empty())
    for (PartId id = 0; id < hulls_.size(); ++id) list.push_back(cast(id, direction, Eigen::Matrix3d::Identity()));
  return list[part];
}

std::pair<double, double> Relations::extent(PartId part, std::size_t direction, std::size_t turn) const {
  const Shadow& s = shadow(part, direction, turn);
  return {s.lo[0], s.hi[0]};
}

std::size_t Relations::turn(const Eigen::Quaterniond& q) {
  const auto known =
      std::find_if(turns_.begin(), turns_.end(), [&](const auto& t) { return std::abs(t.dot(q)) > 1 - 1e-14; });
  if (known == turns_.end()) {
    turns_.push_back(q);
    return turns_.size() - 1;
  }
  return static_cast<std::size_t>(known - turns_.begin());
}

/// One key for both ways of looking at a pair: i along d past j is j along -d past i.
Relations::Key Relations::key_of(const Pair& p) {
  const auto grid = [](double x) { return std::lround(x / kGrid); };
  const Vec3 o = p.moving < p.still ? p.offset : Vec3(-p.offset);
  if (p.moving < p.still)
    return {p.moving, p.still, p.direction, grid(o.x()), grid(o.y()), grid(o.z()), p.turn_moving, p.turn_still};
  return {p.still,      p.moving,     Directions::opposite(p.direction), grid(o.x()), grid(o.y()), grid(o.z()),
          p.turn_still, p.turn_moving};
}

bool Relations::known(const Pair& pair) const { return far(pair) || blocks_.contains(key_of(pair)); }

double Relations::way_past(const Pair& p) const {
  return shadow(p.still, p.direction, p.turn_still).hi[0] - shadow(p.moving, p.direction, p.turn_moving).lo[0] -
         p.offset.dot(directions_.all[p.direction]);
}

bool Relations::far(const Pair& p) const {
  const Shadow &a = shadow(p.moving, p.direction, p.turn_moving), &b = shadow(p.still, p.direction, p.turn_still);
  const Vec3 o = frames_[p.direction] * p.offset;
  if (b.hi[0] - a.lo[0] - o[0] <= 0) return true;  // past it already
  for (int k = 1; k < 3; ++k)
    if (a.lo[k] + o[k] >= b.hi[k] || a.hi[k] + o[k] <= b.lo[k]) return true;
  return false;
}

bool Relations::ask(const Pair& p) const {
  const Pose begin{p.offset, turns_[p.turn_moving]};
  Pose end = begin;
  end.t += (way_past(p) + kBeyond) * directions_.all[p.direction];
  return !judge_.passes(p.moving, p.still, Pose{Vec3::Zero(), turns_[p.turn_still]}, {begin, end});
}

bool Relations::blocks(const Pair& pair) {
  if (far(pair)) return false;
  const Key key = key_of(pair);
  const auto found = blocks_.find(key);
  if (found != blocks_.end()) return found->second;
  ++computed_;
  return blocks_.emplace(key, ask(pair)).first->second;
}

void Relations::compute(std::span<const Pair> pairs, unsigned threads) {
  std::vector<std::pair<Key, const Pair*>> todo;
  for (const Pair& pair : pairs)
    if (!known(pair)) todo.emplace_back(key_of(pair), &pair);
  const auto by_key = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(todo.begin(), todo.end(), by_key);
  todo.erase(std::unique(todo.begin(), todo.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
             todo.end());
  std::vector<char> answers(todo.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < todo.size(); k = next++) answers[k] = ask(*todo[k].second) ? 1 : 0;
  };
  std::vector<std::thread> helpers;
  for (unsigned t = 1; t < threads && t < todo.size(); ++t) helpers.emplace_back(work);
  work();
  for (auto& helper : helpers) helper.join();
  for (std::size_t k = 0; k < todo.size(); ++k) blocks_.emplace(todo[k].first, answers[k] != 0);
  computed_ += todo.size();
}

}  // namespace dismantle::blocking
