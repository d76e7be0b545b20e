#include "overlap_lock/overlap_lock.h"

#include <fmt/format.h>

#include "dismantle/immobility/query.h"
#include "overlap_lock/deep_common_point.h"

namespace dismantle::immobility {
void OverlapLockParameters::describe(Schema<OverlapLockParameters>& s) {
  s.advanced("max_cubes", &OverlapLockParameters::max_cubes, {1});
}

std::optional<Certificate> OverlapLock::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || query.assembly.initial_overlap(pair->first, pair->second) <= 0) return std::nullopt;
  const double limit = depth_allowed(query, pair->first, pair->second);
  for (const auto& [inside, other] : both_orders(*pair))
    for (const Solid& x : solids_of(query, inside))
      for (const Solid& y : solids_of(query, other)) {
        if (context.should_stop()) return std::nullopt;
        const auto p = deep_common_point(x, x.frame, y, y.frame, limit, static_cast<std::uint64_t>(params_.max_cubes));
        if (!p) continue;
        const double allowed = query.assembly.initial_overlap(inside, other) + query.margin();
        Certificate found;
        found.parts = {inside, other};
        found.numbers = {{"point", numbers_of(p->point)}, {"depth", {p->depth}}, {"allowed", {allowed}}};
        found.text = fmt::format(
            "{0} and {1} are locked into each other: {2} lies in both, {3:.4g} below the surface of {0}, so on any "
            "path that separates them {1} penetrates it that deep; {4:.4g} is allowed (see verify.max_penetration)",
            name_of(query, inside), name_of(query, other), position_text(query, p->point),
            input_length(query, p->depth), input_length(query, allowed));
        return found;
      }
  return std::nullopt;
}

}  // namespace dismantle::immobility
