#include "configuration_cells/pin_walk.h"

#include <algorithm>
#include <cmath>

namespace dismantle::immobility {
namespace {

constexpr double kStride = 0.006;   // assembly units, the largest first step
constexpr int kSteps = 60;          // in one direction, ever faster
constexpr std::size_t kKnown = 50;  // poses
constexpr double kAlong = 0.5;      // of the flights
constexpr double kFaster = 1.15, kFastest = 5;
constexpr std::size_t kNearest = 4;  // poses from which it is led
constexpr int kTries = 24;           // to get past what is in the way, each with a shorter step than the last
constexpr double kShorter = 0.84;
constexpr double kAside = 2;    // of what it goes ahead, at most
constexpr double kAhead = 0.1;  // of a step, that is got ahead at least

}  // namespace

PinWalk::PinWalk(const Pinned& pinned, double far) : pinned_(pinned), far_(far) {
  for (std::uint32_t i = 0; i < pinned.pins().size(); ++i) order_.push_back(i);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return pinned.pins()[x].room < pinned.pins()[y].room; });
  add(Vector6::Zero());
}

void PinWalk::wander(std::size_t looks, const RunContext& context) {
  for (const std::size_t until = looks_ + looks; looks_ < until && !away_ && !context.should_stop();) {
    const std::size_t from = rng_.uniform() < 0.6 ? furthest_[rng_.below(12)] : rng_.below(poses_.size());
    const double size = kStride * std::exp2(-2 * rng_.uniform());
    Vector6 step = size * any_way();
    // As one pose lies from another: where there is much less room one way than another, few other steps succeed.
    if (poses_.size() > kKnown && rng_.uniform() < kAlong)
      if (const Vector6 by = apart(); length(by) > 0) step = size / length(by) * by;
    fly(from, step);
  }
}

void PinWalk::lead(const Vector6& to, std::size_t looks, const RunContext& context) {
  const std::size_t until = looks_ + looks;
  while (looks_ < until && !away_ && !context.should_stop()) {
    const std::size_t before = looks_;
    std::vector<std::size_t> starts = nearest(to);
    starts.push_back(0);
    for (const std::size_t from : starts) {
      const Vector6 by = to - poses_[from];
      if (length(by) > 0) slide(from, by / length(by), until);
      if (away_ || looks_ >= until) return;
    }
    if (looks_ == before) return;  // it is there, and nowhere else
  }
}

void PinWalk::add(const Vector6& pose) {
  const std::size_t number = poses_.size();
  poses_.push_back(pose);
  for (int d = 0; d < 6; ++d) {
    const auto at = static_cast<std::size_t>(2 * d);
    if (pose[d] < lo_[d]) lo_[d] = pose[d], furthest_[at] = number;
    if (pose[d] > hi_[d]) hi_[d] = pose[d], furthest_[at + 1] = number;
  }
  if (pose.tail<3>().norm() > far_) away_ = true;
}

bool PinWalk::open(const Vector6& x) {
  ++looks_;
  const Stance stance(pinned_, x);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    if (!stance.barred_by(pinned_.pins()[order_[k]])) continue;
    met_.insert(order_[k]);
    // What was in the way last is asked first.
    std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(k),
                order_.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    return false;
  }
  return true;
}

Vector6 PinWalk::any_way() {
  Vector6 way;
  for (int d = 0; d < 6; ++d) way[d] = rng_.uniform(-1, 1) / (d < 3 ? pinned_.radius() : 1.0);
  return way;
}

Vector6 PinWalk::apart() {
  const std::size_t one = rng_.below(poses_.size()), other = rng_.below(poses_.size());
  return poses_[one] - poses_[other];
}

double PinWalk::dot(const Vector6& x, const Vector6& y) const {
  const double radius = pinned_.radius();
  return radius * radius * x.head<3>().dot(y.head<3>()) + x.tail<3>().dot(y.tail<3>());
}

double PinWalk::length(const Vector6& x) const { return std::sqrt(dot(x, x)); }

std::vector<std::size_t> PinWalk::nearest(const Vector6& to) const {
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t k = 0; k < poses_.size(); ++k) all.emplace_back(length(poses_[k] - to), k);
  const std::size_t count = std::min(kNearest, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(all[k].second);
  return result;
}

/// Straight on, ever faster, as far as it goes. Returns the last pose.
std::size_t PinWalk::fly(std::size_t from, const Vector6& step) {
  double faster = 1;
  for (int k = 0; k < kSteps; ++k) {
    const Vector6 next = poses_[from] + faster * step;
    if (!open(next)) {
      if (k == 0 || faster <= 1) return from;
      faster = 1;
      continue;
    }
    from = poses_.size();
    add(next);
    if (away_) return from;
    faster = std::min(kFastest, kFaster * faster);
  }
  return from;
}

/// That way, as well as it goes: where something is in the way, aside a little; as one pose lies from another, or in
/// any direction.
void PinWalk::slide(std::size_t from, const Vector6& way, std::size_t until) {
  double best = dot(poses_[from], way);
  for (int tries = 0; tries < kTries && looks_ < until && !away_; ++tries) {
    const double size = kStride * std::pow(kShorter, tries);
    Vector6 aside = Vector6::Zero();
    if (tries > 0) {
      aside = tries % 2 == 0 ? any_way() : apart();
      if (const double l = length(aside); l > 0) aside *= kAside * std::exp2(-2 * rng_.uniform()) / l;
    }
    from = fly(from, size * (way + aside));
    if (const double ahead = dot(poses_[from], way); ahead > best + kAhead * size) best = ahead, tries = -1;
  }
}

}  // namespace dismantle::immobility
