#include "base.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dismantle/part_set.h"

namespace dismantle::checks {

namespace {

// Of the size of the assembly. No round figure, so that the rounding of a plan decides about no gap of a design.
constexpr double kTouching = 1.03e-3;
constexpr double kWorthWords = 0.005;

/// What an operation leaves, in ascending order.
std::vector<PartId> result_of(const StepQuestion& operation) {
  std::vector<PartId> all = ids_of(operation.present);
  for (const PlacedPart& p : operation.moving) all.push_back(p.part);
  std::sort(all.begin(), all.end());
  return all;
}

/// The first operation that puts parts on the base of the whole. Those of groups that are built apart are skipped: what
/// they leave is not what the operation after them finds.
const StepQuestion& first_of_the_whole(std::span<const StepQuestion> operations) {
  const StepQuestion* first = &operations.back();
  std::vector<PartId> found = ids_of(first->present);
  std::sort(found.begin(), found.end());
  for (std::size_t k = operations.size() - 1; k-- > 0;)
    if (result_of(operations[k]) == found) {
      first = &operations[k];
      found = ids_of(first->present);
      std::sort(found.begin(), found.end());
    }
  return *first;
}

}  // namespace

Base::Scene::Scene(const Assembly& assembly) : boxes(assembly) {
  for (PartId id = 0; id < assembly.parts.size(); ++id) {
    const PlacedPart alone{id, Pose{}};
    largest = std::max(largest, geometry::half_surface(boxes.assembled()[id]));
    most = std::max(most, neighbours({&alone, 1}));
  }
}

std::size_t Base::Scene::neighbours(std::span<const PlacedPart> parts) const {
  std::size_t count = 0;
  for (PartId id = 0; id < boxes.assembled().size(); ++id) {
    if (contains(parts, id)) continue;
    Aabb box = boxes.assembled()[id];
    box.inflate(kTouching * boxes.size());
    count += std::any_of(parts.begin(), parts.end(),
                         [&](const PlacedPart& p) { return boxes.assembled()[p.part].overlaps(box); })
                 ? 1
                 : 0;
  }
  return count;
}

StepVerdict Base::verdict_of(const Assembly& assembly, std::span<const PlacedPart> base,
                             const Eigen::Vector3d& up) const {
  StepVerdict verdict;
  if (base.empty()) return verdict;
  const std::shared_ptr<const Scene> scene = scenes_.of(assembly);
  // As assembled, with `up` turned along: the base may stand elsewhere while it is built on.
  const Eigen::Vector3d upward = base.front().pose.q.conjugate() * up;
  const auto bottom = [&](const Aabb& b) { return upward.dot(b.center()) - upward.cwiseAbs().dot(0.5 * b.size()); };
  double own = 0, lowest = bottom(scene->boxes.assembled()[base.front().part]), floor = lowest, top = lowest;
  for (const PlacedPart& p : base) {
    const Aabb& box = scene->boxes.assembled()[p.part];
    own += geometry::half_surface(box);
    lowest = std::min(lowest, bottom(box));
  }
  for (const Aabb& box : scene->boxes.assembled()) {
    floor = std::min(floor, bottom(box));
    top = std::max(top, upward.dot(box.center()) + upward.cwiseAbs().dot(0.5 * box.size()));
  }
  const double small = scene->largest > 0 ? 1 - std::min(1.0, own / scene->largest) : 0;
  const double high = top > floor ? (lowest - floor) / (top - floor) : 0;
  const double alone =
      scene->most > 0
          ? 1 - std::min(1.0, static_cast<double>(scene->neighbours(base)) / static_cast<double>(scene->most))
          : 0;
  verdict.cost = (small + high + alone) / 3;
  if (verdict.cost == 0) return verdict;
  std::vector<std::string> why;
  if (small >= kWorthWords)
    why.push_back(fmt::format("has {:.0f} % of the size of the largest part", 100 * (1 - small)));
  if (high >= kWorthWords) why.push_back(fmt::format("begins at {:.0f} % of the height", 100 * high));
  if (alone >= kWorthWords)
    why.push_back(fmt::format("has {:.0f} % of the most neighbours that a part has", 100 * (1 - alone)));
  if (why.empty()) why.emplace_back("is almost the largest, lowest part with the most neighbours");
  verdict.reason =
      fmt::format("the base, '{}'{}, {}", assembly.parts[base.front().part].name,
                  base.size() > 1 ? fmt::format(" and {} more", base.size() - 1) : "", fmt::join(why, ", "));
  return verdict;
}

StepVerdict Base::judge(const StepQuestion& /*question*/, const RunContext& /*context*/) const { return {}; }

StepVerdict Base::estimate(const StepQuestion& question, const RunContext& /*context*/) const {
  if (question.previous != nullptr) return {};
  return verdict_of(question.assembly, question.present, question.up);
}

StepVerdict Base::judge_plan(std::span<const StepQuestion> operations, const RunContext& /*context*/) const {
  if (operations.empty()) return {};
  const StepQuestion& first = first_of_the_whole(operations);
  return verdict_of(first.assembly, first.present, first.up);
}

}  // namespace dismantle::checks
