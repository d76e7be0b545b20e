#include "measure_overlaps.h"

#include <optional>
#include <utility>

#include "dismantle/computed_once.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/verification/contact.h"
#include "dismantle/verification/interruptible_depth.h"
#include "dismantle/verification/verifier.h"
#include "parallel_phase.h"

namespace dismantle {
namespace {

/// The place of a pair that is displaced; nullopt if it is turned other than by quarter turns about the axes: then its
/// region is another box.
std::optional<OverlapPlace> under(const Pose& pose, const OverlapPlace& place) {
  const Eigen::Matrix3d r = pose.q.toRotationMatrix();
  if (!(r.cwiseAbs().rowwise().maxCoeff().array() > 1 - 1e-9).all()) return std::nullopt;
  OverlapPlace moved = place;
  moved.at = pose * place.at;
  moved.region = {};
  if (!place.region.empty()) {
    moved.region.extend(pose * place.region.lo);
    moved.region.extend(pose * place.region.hi);
  }
  if (place.axis) moved.axis = r * *place.axis;
  moved.axis_point = pose * place.axis_point;
  return moved;
}

}  // namespace

std::vector<InitialOverlap> measure_overlaps(const std::vector<Part>& parts, const RunContext& context) {
  std::vector<Aabb> boxes;
  Aabb whole;
  for (const Part& part : parts) {
    boxes.push_back(part.mesh->box());
    whole.extend(boxes.back());
  }
  // Depths are exact to a hundred thousandth of the assembly, a hundredth of the usual tolerance of plans. Less than
  // twice that is rounding: parts touch.
  const double exact_to = 1e-5 * whole.size().maxCoeff(), recorded = 2 * exact_to;
  std::vector<InitialOverlap> pairs;
  std::vector<std::pair<PartId, PartId>> ids;
  for (PartId a = 0; a < boxes.size(); ++a)
    for (PartId b = a + 1; b < boxes.size(); ++b)
      if (boxes[a].overlaps(boxes[b])) {
        pairs.push_back({a, b, 0});
        ids.emplace_back(a, b);
      }
  const std::vector<geometry::PairPlacement> alike = geometry::find_alike(parts, ids, 0.01 * exact_to);
  std::vector<ComputedOnce<DepthBody>> bodies(parts.size());  // prepared once for each part
  const auto body = [&](PartId part) -> const DepthBody& {
    return *bodies[part].get(context, [&] {
      return std::optional<DepthBody>(std::in_place, *parts[part].mesh,
                                      [&] { stop_if_asked(context, "measuring overlaps"); });
    });
  };
  const auto in_parallel = [&](const std::vector<std::size_t>& list, const auto& measure) {
    parallel_phase(
        list.size(), context, "overlaps", [&](std::size_t k) { measure(pairs[list[k]]); },
        [&](std::size_t k) { return parts[pairs[list[k]].a].name + " / " + parts[pairs[list[k]].b].name; });
  };
  const auto classify = [&](InitialOverlap& pair, const Penetration& deepest) {
    pair.depth = deepest.depth;
    if (deepest.depth > recorded) pair.place = classify_overlap(body(pair.a), body(pair.b), deepest, exact_to).place;
  };
  std::vector<std::size_t> first, turned;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (alike[i].original == i) first.push_back(i);
  in_parallel(first, [&](InitialOverlap& pair) {
    const Penetration deepest = deepest_penetration(body(pair.a), Pose{}, body(pair.b), Pose{}, {exact_to}, context);
    if (!context.should_stop()) classify(pair, deepest);  // else only a lower bound; parallel_phase() will throw
  });
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const InitialOverlap& original = pairs[alike[i].original];
    if (alike[i].original == i || !(original.depth > recorded)) continue;
    pairs[i].depth = original.depth;
    pairs[i].place = under(alike[i].pose, *original.place);
    if (!pairs[i].place) turned.push_back(i);
  }
  in_parallel(turned, [&](InitialOverlap& pair) {
    const auto i = static_cast<std::size_t>(&pair - pairs.data());
    classify(pair, {pair.depth, alike[i].pose * pairs[alike[i].original].place->at});
  });
  std::erase_if(pairs, [&](const InitialOverlap& pair) { return !(pair.depth > recorded); });
  return pairs;
}

}  // namespace dismantle
