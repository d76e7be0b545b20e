/// Displaced copies of a part next to another part, at rest. If one of the two is open, they say on which side of a wall
/// a part is, and how far it is behind it: no inside is needed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/sweep.h"

namespace dismantle::geometry {

/// To which side the sheets of an open part lean that are clear of the other part on both sides.
enum class Lean { back, front };

/// Sides of the sheets of a part, as factors of the inward vectors: 1 or -1.
using Sides = std::vector<double>;

/// Corners of a triangle, displaced to a side by a share in [0, 1] of its limit; frame of the triangle's part.
using Displaced = std::function<Corners(std::uint32_t triangle, double side, double share)>;

/// Chooses the side of each sheet of `a`, which `place` maps to the frame of `b`: the one to which the shortest
/// displacement, no longer than the limit, takes it off `b`, and on which it then stays off `b` up to the limit. A closed
/// part has one side only: into it. Sides that are not empty are only confirmed. `reach`: largest limit. Returns a
/// triangle of `a` that meets `b` on both sides, or nullopt.
std::optional<std::uint32_t> find_sides(const Solid& a, const Solid& b, const Placement& place,
                                        const Displaced& displaced, double reach, Lean lean, Sides& sides);

/// True if one copy of `a` or of `b`, displaced by no more than `depth` anywhere, is off the other one. Else `meets` is
/// a point where they meet, in the frame of `b`; unchanged if `depth` is beyond the size of the parts.
bool apart_by(const Solid& a, const Solid& b, const Pose& a_in_b, double depth, Eigen::Vector3d& meets);

}  // namespace dismantle::geometry
