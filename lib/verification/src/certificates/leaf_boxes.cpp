#include "certificates/leaf_boxes.h"

#include <algorithm>

namespace dismantle::certificates {

std::optional<PoseBox> linked_to_zero(const std::vector<PoseBox>& boxes, const RunContext& context) {
  std::vector<PoseBox> left = boxes, pending;
  const auto take = [&](const PoseBox& by) {
    const auto away = [&](const PoseBox& b) {
      return (b.lo.array() > by.hi.array()).any() || (b.hi.array() < by.lo.array()).any();
    };
    const auto first = std::partition(left.begin(), left.end(), away);
    pending.insert(pending.end(), first, left.end());
    left.erase(first, left.end());
  };
  take({Vec6::Zero(), Vec6::Zero()});
  if (pending.empty()) return std::nullopt;
  PoseBox all = pending.front();
  while (!pending.empty() && !context.should_stop()) {
    const PoseBox by = pending.back();
    pending.pop_back();
    all = {all.lo.cwiseMin(by.lo), all.hi.cwiseMax(by.hi)};
    take(by);
  }
  return all;
}

}  // namespace dismantle::certificates
