#include "disc/disc.h"

#include <fmt/format.h>

#include <utility>

#include "disc/disc_cage.h"
#include "dismantle/immobility/bar_middle.h"
#include "dismantle/immobility/query.h"

namespace dismantle::immobility {

void DiscParams::describe(Schema<DiscParams>& s) {
  s.add("max_discs", &DiscParams::max_discs,
        {.unit = "1", .min = 1, .doc = "Discs of each solid, the largest first, that are looked for in chambers."});
  s.add("max_divisions", &DiscParams::max_divisions,
        {.unit = "1", .min = 1, .doc = "Cells of places of the disc's centre that are divided."});
  s.add("max_facets", &DiscParams::max_facets,
        {.unit = "1", .min = 1, .doc = "Facets that are looked at for all cells together; most proofs take a tenth."});
}

std::optional<Certificate> Disc::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair) return std::nullopt;
  auto [inside, other] = *pair;
  if (extent_of(query, other) < extent_of(query, inside)) std::swap(inside, other);
  const double depth = depth_allowed(query, inside, other);
  const auto* middles = middles_of(query, inside, context);
  if (middles == nullptr) return std::nullopt;
  const DiscEffort effort{static_cast<std::size_t>(params_.max_divisions),
                          static_cast<std::size_t>(params_.max_facets)};
  const auto& solids = solids_of(query, inside);
  for (std::size_t i = 0; i < middles->size(); ++i)
    for (const InnerDisc& disc :
         discs_in(solids[i], (*middles)[i], depth, static_cast<std::size_t>(params_.max_discs))) {
      const auto cage = disc_cage(disc, solids_of(query, other), effort, context);
      if (!cage) continue;
      Certificate found;
      found.parts = {inside, other};
      found.numbers = {{"center", numbers_of(disc.center)},
                       {"axis", numbers_of(disc.axis)},
                       {"diameter", {2 * disc.radius}},
                       {"half_thickness", {disc.half}},
                       {"cells", {static_cast<double>(cage->cells)}}};
      found.text = fmt::format(
          "{0} and {1} hold each other: {0} has a flat disc of diameter {2:.4g} about {3} in a chamber of {1}, none of "
          "whose openings it gets through, however it is turned (less the penetration that is allowed)",
          name_of(query, inside), name_of(query, other), input_length(query, 2 * disc.radius),
          place_of(query, disc.center));
      return found;
    }
  return std::nullopt;
}

}  // namespace dismantle::immobility
