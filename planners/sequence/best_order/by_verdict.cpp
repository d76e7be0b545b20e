#include "best_order/by_verdict.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace dismantle::order {

namespace {

constexpr double kAlike = 1e-4;  // above all preferences of directions

using Up = std::optional<Eigen::Vector3d>;

struct Candidate {
  VariantId variant;
  double turn;       // what the step that left before, as assembly the next one, costs more because of this one
  double estimate;   // with `turn`
  std::size_t rank;  // among those of its unit
};

/// What can leave now, that which the estimates like best first; of what they like alike, one motion of each unit.
std::vector<Candidate> candidates(Segment& segment, const Task& task, const UnitSet& present, const Up& up,
                                  VariantId last) {
  std::vector<Candidate> found;
  const double alone = last == kNone ? 0 : segment.cost(last, present, kNone);
  const auto by_estimate = [](const Candidate& a, const Candidate& b) { return a.estimate < b.estimate; };
  present.each([&](std::size_t unit) {
    if (task.end == End::exactly && task.goal.contains(unit)) return;
    const auto first = static_cast<std::ptrdiff_t>(found.size());
    for (const VariantId v : segment.variants_of(unit)) {
      if (segment.up(v) != up || !segment.may_leave(v, present)) continue;
      const double turn = last == kNone ? 0 : segment.cost(last, present, v) - alone;
      const double estimate = turn + segment.cost(v, present - segment.leaving(v), kNone);
      if (estimate < kForbidden) found.push_back({v, turn, estimate, 0});
    }
    std::stable_sort(found.begin() + first, found.end(), by_estimate);
    for (std::size_t i = 0; i + static_cast<std::size_t>(first) < found.size(); ++i)
      found[i + static_cast<std::size_t>(first)].rank = i;
  });
  std::ranges::stable_sort(
      found, {}, [](const Candidate& c) { return std::tuple(std::floor(c.estimate / kAlike), c.rank, c.estimate); });
  return found;
}

/// As many judgements for each step.
Order by_verdict(Segment& segment, const Task& task, const Up& up, double known, std::size_t each) {
  UnitSet present = task.start;
  Order order{{}, 0};
  while (task.end == End::exactly ? !(present == task.goal) : present.size() > 1) {
    VariantId best = kNone;
    double least = kForbidden;
    std::size_t judged = 0;
    for (const Candidate& c :
         candidates(segment, task, present, up, order.variants.empty() ? kNone : order.variants.back())) {
      if (judged == each || least <= c.turn + kAlike) break;
      ++judged;
      const double cost = c.turn + segment.verdict(c.variant, present - segment.leaving(c.variant));
      if (cost < least) {
        least = cost;
        best = c.variant;
      }
    }
    if (best == kNone) return {};
    order.cost += least;
    if (order.cost >= known) return {};
    order.variants.push_back(best);
    present -= segment.leaving(best);
  }
  return order;
}

}  // namespace

std::vector<Step> by_verdict(std::vector<Block>& blocks, const std::vector<std::optional<Eigen::Vector3d>>& ups,
                             double known, std::uint64_t verdicts) {
  std::size_t count = 0;
  for (const Block& block : blocks) count += block.segment ? block.segment->as_planned().size() : 0;
  const std::size_t each = count == 0 ? 0 : static_cast<std::size_t>(verdicts / (count * ups.size()));
  std::vector<Step> best;
  for (const Up& up : ups) {
    if (each == 0) break;
    std::vector<Step> steps;
    double left = known;
    for (Block& block : blocks) {
      for (const Removal* removal : block.fixed) steps.push_back({removal, nullptr, kNone});
      if (!block.segment || block.segment->as_planned().empty()) continue;
      const Order found = by_verdict(*block.segment, block.segment->task(), up, left, each);
      left = found.variants.empty() ? -1 : left - found.cost;
      if (left < 0) break;
      for (const VariantId v : found.variants) steps.push_back({nullptr, block.segment.get(), v});
    }
    if (left <= 0) continue;
    known -= left;  // what it costs
    best = std::move(steps);
  }
  return best;
}

}  // namespace dismantle::order
