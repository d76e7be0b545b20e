#include "spool/spool.h"

#include <fmt/format.h>

#include "dismantle/immobility/query.h"
#include "spool/spool_cage.h"

namespace dismantle::immobility {

void SpoolParams::describe(Schema<SpoolParams>& s) {
  s.add("max_rings", &SpoolParams::max_rings,
        {.unit = "1", .min = 1, .doc = "Circles that are tried about each axis of the spool, the narrowest first."});
  s.add("heights", &SpoolParams::heights,
        {.unit = "1",
         .min = 1,
         .doc = "Advanced. Positions along each axis of the spool at which a circle is searched. Too few may miss thin "
                "plates."});
  s.add("radii", &SpoolParams::radii,
        {.unit = "1",
         .min = 2,
         .doc = "Advanced. Radii that are tried at each position. More radii find a circle closer to the narrowest."});
  s.add("max_sections", &SpoolParams::max_sections,
        {.unit = "1",
         .min = 1,
         .doc = "Advanced. Approximate number of planes across the axis in which rims are searched."});
  s.add("max_dent", &SpoolParams::max_dent,
        {.unit = "verify.max_penetration",
         .min = 0,
         .min_open = true,
         .doc = "Advanced. Distance by which a rim may differ from a convex curve. The circle must be deeper by the "
                "same amount."});
}

std::optional<Certificate> Spool::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  const double depth = depth_allowed(query, pair->first, pair->second);
  for (const auto& [inside, other] : both_orders(*pair))
    for (const Solid& x : solids_of(query, inside))
      for (const Solid& y : solids_of(query, other)) {
        const auto cage =
            spool_cage(x, y, depth, slack_of(query), params_.max_dent * query.tolerance, params_, context);
        if (!cage) continue;
        const double circle = 2 * cage->circle.radius;
        Certificate found;
        found.parts = {inside, other};
        found.numbers = {{"center", numbers_of(cage->circle.center)},
                         {"axis", numbers_of(cage->circle.axis)},
                         {"rim", {cage->rim}},
                         {"circle", {circle}},
                         {"planes", {cage->below, cage->above}}};
        found.text = fmt::format(
            "{0} and {1} hold each other: {0} goes through a hole in {1} at {2} and has rims on both sides, {3:.4g} "
            "wide, which do not pass a circle of diameter {4:.4g} about the hole (with the penetration that is "
            "allowed)",
            name_of(query, inside), name_of(query, other), position_text(query, cage->circle.center),
            input_length(query, cage->rim), input_length(query, circle));
        return found;
      }
  return std::nullopt;
}

}  // namespace dismantle::immobility
