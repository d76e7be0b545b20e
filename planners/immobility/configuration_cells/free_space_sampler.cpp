#include "configuration_cells/free_space_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dismantle::immobility {
namespace {

/// Samples along a curve that visits near ones soon after each other (Morton 1966), obstacle by obstacle.
std::vector<std::uint32_t> along_a_curve(const std::vector<InteriorSample>& samples) {
  constexpr unsigned kBits = 10;  // of each coordinate
  Aabb box;
  for (const InteriorSample& sample : samples) box.extend(sample.at);
  const double size = std::max(box.size().maxCoeff(), std::numeric_limits<double>::min());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    std::uint64_t key = samples[i].obstacle;
    std::array<std::uint32_t, 3> cell;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto n = static_cast<Eigen::Index>(d);
      cell[d] = static_cast<std::uint32_t>((samples[i].at[n] - box.lo[n]) / size * ((1u << kBits) - 1));
    }
    for (unsigned bit = kBits; bit-- > 0;)
      for (const std::uint32_t c : cell) key = key << 1 | (c >> bit & 1);
    keys.emplace_back(key, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  for (const auto& [key, i] : keys) order.push_back(i);
  return order;
}

}  // namespace

// The largest first step is slightly shorter than the tolerance. Walls are thicker than that, so steps do not jump over
// them.
FreeSpaceSampler::FreeSpaceSampler(const SampledPair& pair, double separated, double tolerance)
    : pair_(pair), separated_(separated), stride_(0.6 * tolerance), by_place_(along_a_curve(pair.samples())) {
  for (std::uint32_t i = 0; i < pair.samples().size(); ++i) order_.push_back(i);
  std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t x, std::uint32_t y) {
    return pair.samples()[x].clearance < pair.samples()[y].clearance;
  });
  add(Vector6::Zero());
}

void FreeSpaceSampler::explore(std::size_t checks, const RunContext& context) {
  for (const std::size_t until = checks_ + checks; checks_ < until && !is_separated_ && !context.should_stop();) {
    // The poses at the extremes lead further out; the others find side passages.
    const std::size_t from = rng_.uniform() < 0.6 ? furthest_[rng_.below(12)] : rng_.below(poses_.size());
    const double size = stride_ * std::exp2(-2 * rng_.uniform());
    Vector6 step = size * random_direction();
    // In a narrow passage few random directions succeed. The difference of two free poses is often along the passage,
    // once there are some dozen of them.
    if (poses_.size() > 50 && rng_.uniform() < 0.5)
      if (const Vector6 by = random_difference(); length(by) > 0) step = size / length(by) * by;
    extend_ray(from, step);
  }
}

void FreeSpaceSampler::extend_towards(const Vector6& to, std::size_t checks, const RunContext& context) {
  const std::size_t until = checks_ + checks;
  while (checks_ < until && !is_separated_ && !context.should_stop()) {
    const std::size_t before = checks_;
    std::vector<std::size_t> starts = nearest(to);
    starts.push_back(0);
    for (const std::size_t from : starts) {
      const Vector6 by = to - poses_[from];
      if (length(by) > 0) slide_towards(from, by / length(by), until);
      if (is_separated_ || checks_ >= until) return;
    }
    if (checks_ == before) return;  // all starts are at `to` already
  }
}

void FreeSpaceSampler::add(const Vector6& pose) {
  const std::size_t number = poses_.size();
  poses_.push_back(pose);
  for (int d = 0; d < 6; ++d) {
    const auto at = static_cast<std::size_t>(2 * d);
    if (pose[d] < lo_[d]) lo_[d] = pose[d], furthest_[at] = number;
    if (pose[d] > hi_[d]) hi_[d] = pose[d], furthest_[at + 1] = number;
  }
  if (pose.head<3>().squaredNorm() > furthest_turn().head<3>().squaredNorm()) furthest_turn_ = number;
  if (pose.tail<3>().norm() > separated_) is_separated_ = true;
}

bool FreeSpaceSampler::is_free(const Vector6& x) {
  ++checks_;
  const RelativePose pose(pair_, x);
  const auto blocks = [&](std::uint32_t sample) { return pose.blocked_by(pair_.samples()[sample]); };
  // The first that blocks is mostly one of the last that have. If none of these does, samples near each other in turn
  // look at the same places of their obstacle, which is faster than in the order of `order_`.
  constexpr std::size_t kLikely = 64;
  const auto likely = order_.begin() + static_cast<std::ptrdiff_t>(std::min(kLikely, order_.size()));
  auto first = std::find_if(order_.begin(), likely, blocks);
  if (first == likely) {
    if (!pose.blocked_by_any(by_place_)) return true;
    first = std::find_if(likely, order_.end(), blocks);
  }
  blocking_.insert(*first);
  // The sample that blocks this pose most likely blocks the next one, so it is tested first.
  std::rotate(order_.begin(), first, first + 1);
  return false;
}

Vector6 FreeSpaceSampler::random_direction() {
  Vector6 direction;
  for (int d = 0; d < 6; ++d) direction[d] = rng_.uniform(-1, 1) / (d < 3 ? pair_.radius() : 1.0);
  return direction;
}

Vector6 FreeSpaceSampler::random_difference() {
  const std::size_t one = rng_.below(poses_.size()), other = rng_.below(poses_.size());
  return poses_[one] - poses_[other];
}

double FreeSpaceSampler::dot(const Vector6& x, const Vector6& y) const {
  const double radius = pair_.radius();
  return radius * radius * x.head<3>().dot(y.head<3>()) + x.tail<3>().dot(y.tail<3>());
}

double FreeSpaceSampler::length(const Vector6& x) const { return std::sqrt(dot(x, x)); }

std::vector<std::size_t> FreeSpaceSampler::nearest(const Vector6& to) const {
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t k = 0; k < poses_.size(); ++k) all.emplace_back(length(poses_[k] - to), k);
  const std::size_t count = std::min<std::size_t>(4, all.size());  // the nearest may be behind a wall
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(all[k].second);
  return result;
}

/// Extends along a ray, with steps that grow by 15 % up to fivefold, until a pose is blocked at the first step size.
/// Returns the last pose.
std::size_t FreeSpaceSampler::extend_ray(std::size_t from, const Vector6& step) {
  double faster = 1;
  for (int k = 0; k < 60; ++k) {
    const Vector6 next = poses_[from] + faster * step;
    if (!is_free(next)) {
      if (k == 0 || faster <= 1) return from;
      faster = 1;
      continue;
    }
    from = poses_.size();
    add(next);
    if (is_separated_) return from;
    faster = std::min(5.0, 1.15 * faster);
  }
  return from;
}

/// Extends in a direction as far as it goes. When blocked, it adds a random deviation of up to twice the step, along
/// the difference of two poses or in any direction, and shortens the step each time; the 24th is a hundredth of the
/// first.
void FreeSpaceSampler::slide_towards(std::size_t from, const Vector6& direction, std::size_t until) {
  double best = dot(poses_[from], direction);
  for (int tries = 0; tries < 24 && checks_ < until && !is_separated_; ++tries) {
    const double size = stride_ * std::pow(0.84, tries);
    Vector6 aside = Vector6::Zero();
    if (tries > 0) {
      aside = tries % 2 == 0 ? random_direction() : random_difference();
      if (const double l = length(aside); l > 0) aside *= 2 * std::exp2(-2 * rng_.uniform()) / l;
    }
    from = extend_ray(from, size * (direction + aside));
    if (const double ahead = dot(poses_[from], direction); ahead > best + 0.1 * size) best = ahead, tries = -1;
  }
}

}  // namespace dismantle::immobility
