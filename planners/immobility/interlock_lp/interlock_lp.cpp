#include "interlock_lp/interlock_lp.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/immobility/query.h"
#include "interlock_lp/interlock.h"

namespace dismantle::immobility {

void InterlockLpParameters::describe(Schema<InterlockLpParameters>& s) {
  s.add("max_parts", &InterlockLpParameters::max_parts,
        {.unit = "1",
         .min = 2,
         .max = 64,
         .doc = "Size of the largest group that is tried. Time grows with the cube of the number of parts."});
  s.advanced("max_rounds", &InterlockLpParameters::max_rounds, {1});
  s.advanced("sample_spacing", &InterlockLpParameters::sample_spacing, {.min = 0, .min_open = true});
}

std::optional<Certificate> InterlockLp::prove(const SeparationQuery& query, const RunContext& context) const {
  if (any_open(query)) return std::nullopt;
  std::vector<PartId> parts;
  for (const auto* list : {&query.moving, &query.fixed})
    for (const PlacedPart& p : *list) parts.push_back(p.part);
  if (parts.size() > static_cast<std::size_t>(params_.max_parts)) return std::nullopt;
  std::sort(parts.begin(), parts.end());
  const std::vector<PartId> ascending = parts;
  // Poses are relative to the first part. The largest part gives the smallest relative motions.
  std::stable_sort(parts.begin(), parts.end(),
                   [&](PartId a, PartId b) { return extent_of(query, a) > extent_of(query, b); });
  std::vector<const std::vector<Solid>*> solids;
  for (const PartId id : parts) solids.push_back(&solids_of(query, id));
  std::vector<Neighbours> neighbours;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = i + 1; k < parts.size(); ++k)
      if (near_each_other(query, parts[i], parts[k]))
        neighbours.push_back({i, k, depth_allowed(query, parts[i], parts[k])});
  const auto reach = interlock(solids, neighbours, params_.sample_spacing * query.tolerance,
                               static_cast<int>(params_.max_rounds), context);
  if (!reach) return std::nullopt;
  Certificate found;
  found.parts = ascending;
  found.numbers = {{"depth", {query.margin()}},
                   {"shift", {reach->shift}},
                   {"turn", {reach->turn}},
                   {"half_spaces", {static_cast<double>(reach->half_spaces)}},
                   {"axes", reach->proof.axes},
                   {"bounds", reach->proof.bounds},
                   {"pairs", reach->proof.pairs},
                   {"rows", reach->proof.rows},
                   {"multipliers", reach->proof.multipliers}};
  for (const PartId id : parts)
    found.numbers["order"].push_back(
        static_cast<double>(std::find(ascending.begin(), ascending.end(), id) - ascending.begin()));
  found.text = fmt::format(
      "{0} hold each other in place as rigid bodies: while they penetrate less than {1:.4g} deeper than when "
      "assembled, and whichever of them move, none moves further than {2:.4g} relative to the largest or turns by "
      "more than {3:.4g} rad (proved with {4} half spaces of poses)",
      names_of(query, ascending), input_length(query, query.margin()), input_length(query, reach->shift), reach->turn,
      reach->half_spaces);
  return found;
}

}  // namespace dismantle::immobility
