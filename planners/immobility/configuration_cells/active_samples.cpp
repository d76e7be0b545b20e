#include "configuration_cells/active_samples.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dismantle::immobility {

ActiveSamples::ActiveSamples(const SampledPair& pair, SampleList initial, double tolerance)
    : pair_(pair), list_(std::move(initial)), step_(0.4 * tolerance) {
  active_.assign(pair.samples().size(), false);
  for (const std::uint32_t p : list_) active_[p] = true;
  auto numbers = std::make_shared<SampleList>(pair.samples().size());
  std::iota(numbers->begin(), numbers->end(), 0u);
  all_.samples = std::move(numbers);
}

/// Drops samples that stay outside in the whole cell. Repeated only when the cell has shrunk to half.
void ActiveSamples::update(const PoseCell& cell, const RelativePose& pose, NearSamples& near) const {
  const Vector6 half = 0.5 * cell.size();
  const double turn = half.head<3>().norm(), shift = half.tail<3>().norm();
  const double reach = turn * pair_.radius() + shift;
  if (reach > 0.5 * near.reach) return;
  auto nearer = std::make_shared<SampleList>();
  for (const std::uint32_t p : *near.samples) {
    const InteriorSample& sample = pair_.samples()[p];
    const double moves = turn * sample.at.norm() + shift;
    if (pose.inside(sample) || pair_.obstacle(sample).solid->bvh.closest(pose.position(sample), moves).distance < moves)
      nearer->push_back(p);
  }
  near = {std::move(nearer), reach};
}

void ActiveSamples::activate_deepest(const PoseCell& cell, NearSamples& near) {
  const RelativePose pose(pair_, cell.center());
  update(cell, pose, near);
  const std::uint32_t* best = nullptr;
  double deepest = 0;
  for (const std::uint32_t& p : *near.samples) {
    const InteriorSample& sample = pair_.samples()[p];
    if (active_[p] || !pose.blocked_by(sample)) continue;
    const double depth = pair_.obstacle(sample).solid->bvh.closest(pose.position(sample)).distance;
    if (depth > deepest) deepest = depth, best = &p;
  }
  if (best == nullptr) return;
  active_[*best] = true;
  list_.push_back(*best);
}

bool ActiveSamples::is_free(const Vector6& x, const PoseCell& around) const {
  const RelativePose pose(pair_, x);
  const auto& samples = pair_.samples();
  if (std::any_of(around.samples->begin(), around.samples->end(),
                  [&](std::uint32_t p) { return pose.inside(samples[p]); }))
    return false;
  return std::none_of(samples.begin(), samples.end(), [&](const InteriorSample& s) { return pose.blocked_by(s); });
}

bool ActiveSamples::is_free(const Vector6& from, const Vector6& to) const {
  const Vector6 by = to - from;
  const int steps = 1 + static_cast<int>(by.cwiseProduct(pair_.scale()).norm() / step_);
  for (int i = 1; i < steps; ++i) {
    const RelativePose pose(pair_, from + static_cast<double>(i) / steps * by);
    if (std::any_of(list_.begin(), list_.end(), [&](std::uint32_t p) { return pose.blocked_by(pair_.samples()[p]); }))
      return false;
  }
  return true;
}

}  // namespace dismantle::immobility
