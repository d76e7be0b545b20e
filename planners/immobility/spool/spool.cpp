#include "spool/spool.h"

#include <fmt/format.h>

#include "dismantle/immobility/query.h"
#include "spool/spool_cage.h"

namespace dismantle::immobility {

void SpoolParams::describe(Schema<SpoolParams>& s) {
  s.add("max_rings", &SpoolParams::max_rings,
        {.unit = "1", .min = 1, .doc = "Circles about each axis of the spool, the narrowest first, that are tried."});
}

std::optional<Certificate> Spool::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  const double depth = depth_allowed(query, pair->first, pair->second);
  for (const auto& [inside, other] : both_ways(*pair))
    for (const Solid& x : solids_of(query, inside))
      for (const Solid& y : solids_of(query, other)) {
        const auto cage = spool_cage(x, y, depth, static_cast<std::size_t>(params_.max_rings), context);
        if (!cage) continue;
        const double circle = 2 * cage->ring.radius;
        Certificate found;
        found.parts = {inside, other};
        found.numbers = {{"center", numbers_of(cage->ring.center)},
                         {"axis", numbers_of(cage->ring.axis)},
                         {"rim", {cage->rim}},
                         {"circle", {circle}}};
        found.text = fmt::format(
            "{0} and {1} hold each other: {0} goes through a hole in {1} at {2}, and has rims on both sides, {3:.4g} "
            "wide, where a circle of {4:.4g} about the hole keeps them off (with the penetration that is allowed)",
            name_of(query, inside), name_of(query, other), place_of(query, cage->ring.center),
            input_length(query, cage->rim), input_length(query, circle));
        return found;
      }
  return std::nullopt;
}

}  // namespace dismantle::immobility
