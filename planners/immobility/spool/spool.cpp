#include "spool/spool.h"

#include <fmt/format.h>

#include "dismantle/immobility/query.h"
#include "spool/spool_cage.h"

namespace dismantle::immobility {

void SpoolParameters::describe(Schema<SpoolParameters>& s) {
  s.advanced("max_rings", &SpoolParameters::max_rings, {1});
  s.advanced("heights", &SpoolParameters::heights, {1});
  s.advanced("radii", &SpoolParameters::radii, {2});
  s.advanced("max_sections", &SpoolParameters::max_sections, {1});
  s.advanced("max_dent", &SpoolParameters::max_dent, {.min = 0, .min_open = true});
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
