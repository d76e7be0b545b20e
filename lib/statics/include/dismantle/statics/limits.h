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

/// How far a pile can be tilted.
struct TiltLimit {
  std::optional<double>
      angle{};        ///< rad, at which it no longer stands; none: it stands at every angle up to 89 degrees
  double stands = 0;  ///< the last angle that is certified on the way there
  std::optional<double> falls{};  ///< an angle at which no forces balance it, by Farkas; none: not known
  bool found = true;              ///< false: ended by `stop`, and the angle is that of `stands`
};
/// Of a tilt by the right-hand rule about `axis`. `displacement`: that of the pile as it is, which stands.
DISMANTLE_API TiltLimit tilt_limit(const Pile& pile, const Eigen::Vector3d& axis, const Motions& displacement,
                                   const std::function<bool()>& stop = {});

/// Smallest angle > 0 (rad) of a tilt at which the pile no longer stands; 0: it does not stand as it is; none: it
/// stands at every angle up to 89 degrees. Where no forces balance the pile from there on, from Farkas' motions.
DISMANTLE_API std::optional<double> critical_tilt(const Pile& pile, const Eigen::Vector3d& axis,
                                                  const std::function<bool()>& stop = {});

/// The smallest horizontal push at the centre of a body after which no forces balance the pile.
struct LeastPush {
  std::uint32_t body = 0;
  double force = 0;           ///< in the unit of the weights
  Eigen::Vector3d direction;  ///< unit
  Motions motion{};           ///< what then moves
  bool exact = true;          ///< false: a smaller push may do, too
};
/// None: no push moves it. Of sixteen directions; each limit is an upper bound by Farkas and exact to rounding. `near`:
/// displacement without the push, for the associated law. `bound`: what least_push_alone() found.
DISMANTLE_API std::optional<LeastPush> least_push(const Pile& pile, std::uint32_t body,
                                                  const std::function<bool()>& stop = {}, const Motions& near = {},
                                                  const std::optional<LeastPush>& bound = {});
/// The same when no other body moves: an upper bound, and much faster. Not `exact`.
DISMANTLE_API std::optional<LeastPush> least_push_alone(const Pile& pile, std::uint32_t body,
                                                        const std::function<bool()>& stop = {});

}  // namespace dismantle::statics
