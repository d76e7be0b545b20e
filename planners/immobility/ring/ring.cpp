#include "ring/ring.h"

#include <fmt/format.h>

#include "dismantle/immobility/query.h"
#include "ring/ring_cage.h"

namespace dismantle::immobility {

void RingParameters::describe(Schema<RingParameters>& s) {
  s.advanced("max_rings", &RingParameters::max_rings, {1});
  s.advanced("heights", &RingParameters::heights, {1});
  s.advanced("radii", &RingParameters::radii, {1});
  s.advanced("max_sections", &RingParameters::max_sections, {1});
}

std::optional<Certificate> Ring::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  const double depth = depth_allowed(query, pair->first, pair->second);
  for (const auto& [inside, other] : both_orders(*pair))
    for (const Solid& x : solids_of(query, inside))
      for (const InteriorCircle& ring : circles_in(x, depth, params_))
        for (const Solid& y : solids_of(query, other)) {
          const auto cage = ring_cage(ring, y, slack_of(query), params_, context);
          if (!cage) continue;
          Certificate found;
          found.parts = {inside, other};
          found.numbers = {{"center", numbers_of(ring.center)},
                           {"axis", numbers_of(ring.axis)},
                           {"diameter", {2 * ring.radius}},
                           {"opening", {cage->opening}},
                           {"planes", cage->planes}};
          found.text = fmt::format(
              "{0} and {1} hold each other: {0} has a ring of diameter {2:.4g} about {3} in a chamber of {1}, which "
              "opens no wider than {4:.4g} (less the penetration that is allowed)",
              name_of(query, inside), name_of(query, other), input_length(query, 2 * ring.radius),
              position_text(query, ring.center), input_length(query, cage->opening));
          return found;
        }
  return std::nullopt;
}

}  // namespace dismantle::immobility
