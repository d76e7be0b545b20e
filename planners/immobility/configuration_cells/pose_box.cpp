#include "configuration_cells/pose_box.h"

#include <algorithm>

namespace dismantle::immobility {
namespace {

constexpr double kOnBorder = 1e-12;
constexpr std::size_t kPatience = 500;  // rounds in which all ways led to the same sides
constexpr double kMargin = 0.2;         // of what the walk reached, on either side, ...
constexpr double kLeastMargin = 0.02;   // ... and assembly units
constexpr double kGrow = 0.15;          // of the box, on a side that is too close, ...
constexpr double kGrowMore = 1.6;       // ... and so many times more each time

}  // namespace

PoseBox::PoseBox(const PinWalk& walk, const Vector6& scale)
    : scale_(scale), lo_(walk.lo() - margin(walk)), hi_(walk.hi() + margin(walk)) {
  share_.fill(kGrow);
}

Vector6 PoseBox::margin(const PinWalk& walk) const {
  return kMargin * (walk.hi() - walk.lo()) + kLeastMargin * scale_.cwiseInverse();
}

PoseBox::Sides PoseBox::touched(const PoseCell& cell) const {
  Sides sides{};
  for (int d = 0; d < 6; ++d) {
    sides[side(d, false)] = !cell.empty && cell.lo[d] - lo_[d] < kOnBorder;
    sides[side(d, true)] = !cell.empty && hi_[d] - cell.hi[d] < kOnBorder;
  }
  return sides;
}

double PoseBox::from_border(const PoseCell& cell) const {
  const Vector6 size = hi_ - lo_;
  return std::min((cell.lo - lo_).cwiseQuotient(size).minCoeff(), (hi_ - cell.hi).cwiseQuotient(size).minCoeff());
}

Vector6 PoseBox::beyond(const PoseCell& cell) const {
  const Sides sides = touched(cell);
  const Vector6 out = kGrow * (hi_ - lo_);
  Vector6 x = cell.center();
  for (int d = 0; d < 6; ++d) {
    // A cell that reaches from side to side tells no direction.
    if (sides[side(d, false)] == sides[side(d, true)]) continue;
    x[d] = sides[side(d, true)] ? hi_[d] + out[d] : lo_[d] - out[d];
  }
  return x;
}

void PoseBox::led_to(const PoseCell& cell, bool tells, std::size_t round) {
  if (!tells) began_ = round;
  const Sides sides = touched(cell);
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (sides[k]) led_at_[k] = round;
}

PoseBox::Sides PoseBox::insisted_on(std::size_t round) const {
  std::size_t before = began_;
  for (const std::size_t at : led_at_)
    if (at != round) before = std::max(before, at);
  Sides sides{};
  if (round >= before + kPatience)
    for (std::size_t k = 0; k < sides.size(); ++k) sides[k] = led_at_[k] == round;
  return sides;
}

PoseBox::Sides PoseBox::passed_by(const PinWalk& walk) const {
  Sides sides{};
  for (int d = 0; d < 6; ++d) {
    sides[side(d, false)] = walk.lo()[d] < lo_[d];
    sides[side(d, true)] = walk.hi()[d] > hi_[d];
  }
  return sides;
}

PoseCell PoseBox::grow(int d, bool upper, const PinWalk& walk) {
  double& share = share_[side(d, upper)];
  double by = share * (hi_[d] - lo_[d]);
  const double needed = margin(walk)[d] + (upper ? walk.hi()[d] - hi_[d] : lo_[d] - walk.lo()[d]);
  if (needed > by)
    by = needed;
  else
    share *= kGrowMore;
  PoseCell slab;
  slab.lo = lo_;
  slab.hi = hi_;
  if (upper) {
    slab.lo[d] = hi_[d];
    slab.hi[d] = hi_[d] += by;
  } else {
    slab.hi[d] = lo_[d];
    slab.lo[d] = lo_[d] -= by;
  }
  slab.pins = std::make_shared<PinList>();
  return slab;
}

}  // namespace dismantle::immobility
