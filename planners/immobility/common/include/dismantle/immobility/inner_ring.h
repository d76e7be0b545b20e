/// Circles within a solid, and the axes about which they are looked for.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// A circle within a solid, everywhere deeper below its surface than was asked for. Assembled frame.
struct InnerRing {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double radius = 0;
};

inline constexpr int kRingHeights = 24, kRingRadii = 32;  ///< where rings are looked for
inline constexpr int kArcHalvings = 12;                   ///< of arcs, to prove that all of a ring is deep enough

/// The point of the ring at an angle from a fixed direction; rad.
Eigen::Vector3d point_on(const InnerRing& ring, double angle);

/// Is all of the arc between two angles deeper in the solid than `depth`? Shown by at most so many halvings of it:
/// depths change no faster than the point moves.
bool is_deep(const Solid& solid, const InnerRing& ring, double depth, double from, double to, int halvings);
/// Are some points of the ring?
bool looks_deep(const Solid& solid, const InnerRing& ring, double depth);

/// Directions about which a solid may be round: its axes of inertia, and across its largest flat faces. Its frame.
struct RoundAxes {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the surface
  std::vector<Eigen::Vector3d> all;                  ///< unit
};
RoundAxes round_axes_of(const Solid& solid);

}  // namespace dismantle::immobility
