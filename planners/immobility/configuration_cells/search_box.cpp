#include "configuration_cells/search_box.h"

#include <algorithm>

namespace dismantle::immobility {
namespace {

// Share of the box by which a side moves out the first time. Much less takes many rounds, much more adds free space
// that must be divided.
constexpr double kFirstGrowth = 0.15;

}  // namespace

// The least margin is two tolerances: about the range of motion of parts that touch.
SearchBox::SearchBox(const FreeSpaceSampler& sampler, const Vector6& scale, std::size_t patience, double tolerance)
    : scale_(scale),
      patience_(patience),
      least_margin_(2 * tolerance),
      lo_(sampler.lo() - margin(sampler)),
      hi_(sampler.hi() + margin(sampler)) {
  growth_.fill(kFirstGrowth);
}

/// A fifth of the range of the sampled poses, since a random search does not reach the end of the free range.
Vector6 SearchBox::margin(const FreeSpaceSampler& sampler) const {
  return 0.2 * (sampler.hi() - sampler.lo()) + least_margin_ * scale_.cwiseInverse();
}

/// contract() leaves a face that does not move exactly where it is, so the comparison is exact.
SearchBox::Sides SearchBox::sides_touched(const PoseCell& cell) const {
  Sides sides{};
  for (int d = 0; d < 6; ++d) {
    sides[side(d, false)] = !cell.empty && cell.lo[d] <= lo_[d];
    sides[side(d, true)] = !cell.empty && cell.hi[d] >= hi_[d];
  }
  return sides;
}

double SearchBox::border_distance(const PoseCell& cell) const {
  const Vector6 size = hi_ - lo_;
  return std::min((cell.lo - lo_).cwiseQuotient(size).minCoeff(), (hi_ - cell.hi).cwiseQuotient(size).minCoeff());
}

Vector6 SearchBox::pose_beyond(const PoseCell& cell) const {
  const Sides sides = sides_touched(cell);
  const Vector6 out = kFirstGrowth * (hi_ - lo_);
  Vector6 x = cell.center();
  for (int d = 0; d < 6; ++d) {
    // A cell that reaches from one side to the other does not tell the direction.
    if (sides[side(d, false)] == sides[side(d, true)]) continue;
    x[d] = sides[side(d, true)] ? hi_[d] + out[d] : lo_[d] - out[d];
  }
  return x;
}

void SearchBox::record_exit(const PoseCell& cell, bool small, std::size_t round) {
  if (!small) restarted_at_ = round;
  const Sides sides = sides_touched(cell);
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (sides[k]) last_exit_[k] = round;
}

SearchBox::Sides SearchBox::persistent_sides(std::size_t round) const {
  std::size_t before = restarted_at_;
  for (const std::size_t at : last_exit_)
    if (at != round) before = std::max(before, at);
  Sides sides{};
  if (round >= before + patience_)
    for (std::size_t k = 0; k < sides.size(); ++k) sides[k] = last_exit_[k] == round;
  return sides;
}

SearchBox::Sides SearchBox::sides_exceeded(const FreeSpaceSampler& sampler) const {
  Sides sides{};
  for (int d = 0; d < 6; ++d) {
    sides[side(d, false)] = sampler.lo()[d] < lo_[d];
    sides[side(d, true)] = sampler.hi()[d] > hi_[d];
  }
  return sides;
}

PoseCell SearchBox::grow(int d, bool upper, const FreeSpaceSampler& sampler) {
  double& share = growth_[side(d, upper)];
  double by = share * (hi_[d] - lo_[d]);
  const double needed = margin(sampler)[d] + (upper ? sampler.hi()[d] - hi_[d] : lo_[d] - sampler.lo()[d]);
  if (needed > by)
    by = needed;
  else
    share *= 1.6;  // a long free motion on that side needs only a few growths
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
  slab.samples = std::make_shared<SampleList>();
  return slab;
}

}  // namespace dismantle::immobility
