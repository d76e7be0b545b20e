/// How far a motion that is not valid is valid.
#pragma once

#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Poses of the moving parts at a place of a path: instant `place` rounded down, and the share of the screw motion to
/// the next one. `place` is in [0, path.size() - 1].
DISMANTLE_API std::vector<Pose> instant_at(const Path& path, double place);

/// The path up to that place: at least two instants.
DISMANTLE_API Path up_to(const Path& path, double place);

/// The latest place up to which rule (b) is proved, when `moving` follows `path` past `fixed`; no later place is
/// further away than `max_penetration`, measured as the travel of the parts. 0: it cuts in from the beginning. nullopt:
/// told to stop.
DISMANTLE_API std::optional<double> valid_until(const Assembly& assembly, const Verifier& verifier,
                                                const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                                const Path& path, const RunContext& context);

/// The path with an instant at the place that valid_until() finds, unless there is one; as it is when told to stop.
DISMANTLE_API Path divided_where_valid(const Assembly& assembly, const Verifier& verifier,
                                       const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                       Path path, const RunContext& context);

/// The last instant up to which rule (b) is proved; 0: none, or told to stop.
DISMANTLE_API std::size_t last_valid_instant(const Verifier& verifier, const std::vector<PartId>& moving,
                                             const std::vector<PlacedPart>& fixed, const Path& path,
                                             const RunContext& context);

}  // namespace dismantle
