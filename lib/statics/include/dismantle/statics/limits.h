/// How far a pile is from falling: critical tilts and pushes.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/verdict.h"

namespace dismantle::statics {

/// The pile after a tilt by the right-hand rule about `axis` (unit).
DISMANTLE_API Pile tilted(Pile pile, const Eigen::Vector3d& axis, double angle);

/// Smallest angle > 0 (rad) of a tilt at which the pile no longer stands; 0: it does not stand as it is; none: it
/// stands at every angle up to 89 degrees. From Farkas' motions for the forces, by halving where forces exist that
/// nothing creates.
DISMANTLE_API std::optional<double> critical_tilt(const Pile& pile, const Eigen::Vector3d& axis,
                                                  const std::function<bool()>& stop = {});

/// The smallest horizontal push at the centre of a body after which no forces balance the pile.
struct LeastPush {
  std::uint32_t body = 0;
  double force = 0;           ///< in the unit of the weights
  Eigen::Vector3d direction;  ///< unit
  Motions motion{};           ///< what then moves
};
/// None: no push moves it. Of sixteen directions; each limit is an upper bound by Farkas and exact to rounding.
DISMANTLE_API std::optional<LeastPush> least_push(const Pile& pile, std::uint32_t body,
                                                  const std::function<bool()>& stop = {});

}  // namespace dismantle::statics
