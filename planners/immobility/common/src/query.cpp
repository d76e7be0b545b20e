#include "dismantle/immobility/query.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dismantle/part_memo.h"

namespace dismantle::immobility {

const std::vector<Solid>& solids_of(const SeparationQuery& query, PartId part) {
  return *query.memo.get<std::vector<Solid>>("solids", part, RunContext{}, [&] {
    return std::optional(split_into_solids(*query.assembly.parts.at(part).mesh));
  });
}

double depth_allowed(const SeparationQuery& query, PartId a, PartId b) {
  constexpr double kRoundingMargin = 1e-6;  // relative; initial overlaps are measured much less exactly, from below
  return (query.assembly.initial_overlap(a, b) + query.margin()) * (1 + kRoundingMargin);
}

double slack_of(const SeparationQuery& query) { return 1e-4 * query.tolerance; }

bool near_each_other(const SeparationQuery& query, PartId a, PartId b) {
  Aabb near = query.assembly.parts.at(a).mesh->box();
  near.inflate(query.tolerance);
  return near.overlaps(query.assembly.parts.at(b).mesh->box());
}

bool is_open(const SeparationQuery& query, PartId part) { return query.assembly.parts.at(part).open; }

bool any_open(const SeparationQuery& query) {
  const auto open = [&](const PlacedPart& p) { return is_open(query, p.part); };
  return std::ranges::any_of(query.moving, open) || std::ranges::any_of(query.fixed, open);
}

std::optional<std::pair<PartId, PartId>> pair_of(const SeparationQuery& query) {
  if (query.moving.size() != 1 || query.fixed.size() != 1) return std::nullopt;
  if (any_open(query)) return std::nullopt;
  return std::minmax({query.moving.front().part, query.fixed.front().part});
}

std::array<std::pair<PartId, PartId>, 2> both_orders(const std::pair<PartId, PartId>& pair) {
  return {pair, std::pair(pair.second, pair.first)};
}

double extent_of(const SeparationQuery& query, PartId part) {
  return query.assembly.parts.at(part).mesh->box().size().norm();
}

std::string name_of(const SeparationQuery& query, PartId part) {
  return fmt::format("'{}'", query.assembly.parts.at(part).name);
}

std::string names_of(const SeparationQuery& query, const std::vector<PartId>& parts) {
  std::vector<std::string> names;
  for (const PartId id : parts) names.push_back(name_of(query, id));
  return fmt::format("{}", fmt::join(names, ", "));
}

double input_length(const SeparationQuery& query, double length) { return length / query.assembly.normalization.scale; }

std::string position_text(const SeparationQuery& query, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = query.assembly.normalization.to_input(point);
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

}  // namespace dismantle::immobility
