#include "configuration_cells/pins_in_use.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dismantle::immobility {
namespace {

constexpr double kStep = 0.004;      // assembly units: on a way that is looked at
constexpr double kFirstReach = 0.6;  // assembly units: in larger cells most pins are close
constexpr double kCloser = 0.5;      // of the reach for which pins were last left out: it is done again

}  // namespace

PinsInUse::PinsInUse(const Pinned& pinned, PinList begin_with) : pinned_(pinned), list_(std::move(begin_with)) {
  used_.assign(pinned.pins().size(), false);
  for (const std::uint32_t p : list_) used_[p] = true;
  auto numbers = std::make_shared<PinList>(pinned.pins().size());
  std::iota(numbers->begin(), numbers->end(), 0u);
  all_ = {std::move(numbers), kFirstReach};
}

void PinsInUse::look_closer(const PoseCell& cell, const Stance& stance, ClosePins& close) const {
  const Vector6 half = 0.5 * cell.size();
  const double turn = half.head<3>().norm(), shift = half.tail<3>().norm();
  const double reach = turn * pinned_.radius() + shift;
  if (reach > kCloser * close.reach) return;
  auto closer = std::make_shared<PinList>();
  for (const std::uint32_t p : *close.pins) {
    const Pin& pin = pinned_.pins()[p];
    const double way = turn * pin.at.norm() + shift;
    if (stance.inside(pin) || pinned_.faced(pin).solid->bvh.closest(stance.seen(pin), way).distance < way)
      closer->push_back(p);
  }
  close = {std::move(closer), reach};
}

void PinsInUse::learn(const PoseCell& cell, ClosePins& close) {
  const Stance stance(pinned_, cell.center());
  look_closer(cell, stance, close);
  const std::uint32_t* best = nullptr;
  double deepest = 0;
  for (const std::uint32_t& p : *close.pins) {
    const Pin& pin = pinned_.pins()[p];
    if (used_[p] || !stance.barred_by(pin)) continue;
    const double depth = pinned_.faced(pin).solid->bvh.closest(stance.seen(pin)).distance;
    if (depth > deepest) deepest = depth, best = &p;
  }
  if (best == nullptr) return;
  used_[*best] = true;
  list_.push_back(*best);
}

bool PinsInUse::within_bounds(const Vector6& x, const PoseCell& around) const {
  const Stance stance(pinned_, x);
  const auto& pins = pinned_.pins();
  if (std::any_of(around.pins->begin(), around.pins->end(), [&](std::uint32_t p) { return stance.inside(pins[p]); }))
    return false;
  return std::none_of(pins.begin(), pins.end(), [&](const Pin& p) { return stance.barred_by(p); });
}

bool PinsInUse::passes(const Vector6& from, const Vector6& to) const {
  const Vector6 by = to - from;
  const int steps = 1 + static_cast<int>(by.cwiseProduct(pinned_.scale()).norm() / kStep);
  for (int i = 1; i < steps; ++i) {
    const Stance stance(pinned_, from + static_cast<double>(i) / steps * by);
    if (std::any_of(list_.begin(), list_.end(), [&](std::uint32_t p) { return stance.barred_by(pinned_.pins()[p]); }))
      return false;
  }
  return true;
}

}  // namespace dismantle::immobility
