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

const Relations::Shadow& Relations::shadow(PartId part, std::size_t direction) const {
  auto& list = shadows_[direction];
  if (list.empty()) {
    for (const auto& hull : hulls_) {
      Shadow s;
      for (int k = 0; k < 3; ++k) s.lo[k] = std::numeric_limits<double>::infinity(), s.hi[k] = -s.lo[k];
      for (const Vec3& v : hull) {
        const Vec3 p = frames_[direction] * v;
        for (int k = 0; k < 3; ++k) s.lo[k] = std::min(s.lo[k], p[k]), s.hi[k] = std::max(s.hi[k], p[k]);
      }
      list.push_back(s);
    }
  }
  return list[part];
}

std::pair<double, double> Relations::extent(PartId part, std::size_t direction) const {
  const Shadow& s = shadow(part, direction);
  return {s.lo[0], s.hi[0]};
}

/// One key for both ways of looking at a pair: i along d past j is j along -d past i.
Relations::Key Relations::key_of(const Pair& p) {
  const auto grid = [](double x) { return std::lround(x / kGrid); };
  const Vec3 o = p.moving < p.still ? p.offset : Vec3(-p.offset);
  if (p.moving < p.still) return {p.moving, p.still, p.direction, grid(o.x()), grid(o.y()), grid(o.z())};
  return {p.still, p.moving, Directions::opposite(p.direction), grid(o.x()), grid(o.y()), grid(o.z())};
}

bool Relations::known(const Pair& pair) const { return far(pair) || blocks_.contains(key_of(pair)); }

double Relations::way_past(const Pair& p) const {
  return shadow(p.still, p.direction).hi[0] - shadow(p.moving, p.direction).lo[0] -
         p.offset.dot(directions_.all[p.direction]);
}

bool Relations::far(const Pair& p) const {
  const Shadow &a = shadow(p.moving, p.direction), &b = shadow(p.still, p.direction);
  const Vec3 o = frames_[p.direction] * p.offset;
  if (b.hi[0] - a.lo[0] - o[0] <= 0) return true;  // past it already
  for (int k = 1; k < 3; ++k)
    if (a.lo[k] + o[k] >= b.hi[k] || a.hi[k] + o[k] <= b.lo[k]) return true;
  return false;
}

bool Relations::ask(const Pair& p) const {
  const Pose begin{p.offset, Eigen::Quaterniond::Identity()};
  Pose end = begin;
  end.t += (way_past(p) + kBeyond) * directions_.all[p.direction];
  return !judge_.passes(p.moving, p.still, Pose{}, {begin, end});
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
