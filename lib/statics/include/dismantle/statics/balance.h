/// Forces that balance a pile, by convex programs in the displacements.
///
/// Each contact point is a stiff spring that pushes and rubs. With the associated law its force is the projection of
/// the elastic force on the friction cone; the sum of the elastic energies is convex, and a minimum exists exactly if
/// forces in the cones balance the load. With Coulomb's law friction opposes the sliding and is limited by the
/// pressure; a fixed point of convex programs with given limits is a state that the load itself creates. The cones are
/// circular, not pyramids. A proximal term keeps each program strictly convex: Newton's method with sparse factors
/// solves it, and what remains unbalanced is the motion of falling (Moreau's decomposition of the load).
#pragma once

#include <functional>
#include <optional>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// How a contact answers sliding.
enum class FrictionLaw { associated, coulomb };

/// Result of balance().
struct Balance {
  bool balanced = false;   ///< residual below the tolerance
  double residual = 1;     ///< largest unbalanced share of a weight
  ContactForces forces{};  ///< at the last iterate
  Motions displacement{};  ///< that creates the forces
  Motions falling{};       ///< not balanced: the direction of the unbalanced motion
  unsigned factorizations = 0;
};

/// Looks for a balance. `stop`: asked between programs; true gives up. `near`: displacement of a similar load on the
/// same bodies, from which the search starts; empty: it starts where nothing is displaced.
DISMANTLE_API Balance balance(const Pile& pile, FrictionLaw law, const std::function<bool()>& stop = {},
                              const Motions& near = {});

/// Is it balanced, with certificates of standing that pass?
DISMANTLE_API bool is_certified(const Pile& pile, const Balance& balance);

/// Coulomb's law, from the displacement of a similar load alone. With certificates that pass; none: it is not near
/// enough, or no displacement creates such forces.
DISMANTLE_API std::optional<Balance> balance_near(const Pile& pile, const Motions& near,
                                                  const std::function<bool()>& stop = {});

/// About how many multiplications all balances on this thread have taken so far.
DISMANTLE_API double work_done();

}  // namespace dismantle::statics
