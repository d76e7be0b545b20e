#include "hook/hook.h"

#include <fmt/format.h>

#include "dismantle/immobility/bar_middle.h"
#include "dismantle/immobility/query.h"
#include "hook/hook_cage.h"

namespace dismantle::immobility {

void HookParams::describe(Schema<HookParams>& s) {
  s.add("max_holes", &HookParams::max_holes,
        {.unit = "1", .min = 1, .doc = "Holes around the middle of a bar that are tried, the narrowest first."});
  s.add("max_bends", &HookParams::max_bends,
        {.unit = "1", .min = 1, .doc = "Bends on each side of a hole that are tried, the sharpest first."});
}

std::optional<Certificate> Hook::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  const double depth = depth_allowed(query, pair->first, pair->second);
  const HookEffort effort{static_cast<std::size_t>(params_.max_holes), static_cast<std::size_t>(params_.max_bends)};
  for (const auto& [inside, other] : both_ways(*pair)) {
    const auto* middles = middles_of(query, inside, context);
    if (middles == nullptr) return std::nullopt;
    const auto& bars = solids_of(query, inside);
    for (std::size_t i = 0; i < bars.size(); ++i)
      for (const Solid& y : solids_of(query, other)) {
        const auto cage = hook_cage(bars[i], (*middles)[i], y, depth, effort, context);
        if (!cage) continue;
        Certificate found;
        found.parts = {inside, other};
        found.numbers = {{"hole", numbers_of(cage->hole)},
                         {"width", {cage->width}},
                         {"first_bend", numbers_of(cage->bends[0].corner)},
                         {"second_bend", numbers_of(cage->bends[1].corner)}};
        found.text = fmt::format(
            "{0} and {1} hold each other: {0} goes through a hole in {1} at {2}, {3:.4g} wide, and is "
            "bent on both sides; neither bend can follow, less the penetration that is allowed",
            name_of(query, inside), name_of(query, other), place_of(query, cage->hole),
            input_length(query, cage->width));
        return found;
      }
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
