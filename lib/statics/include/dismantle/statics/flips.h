/// What an uncertain verdict changes with: similar piles with certified verdicts that differ.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/verdict.h"

namespace dismantle::statics {

/// The most that a pile is varied by: a share of the friction coefficient, or an angle (rad).
inline constexpr double kMostVaried = 0.01;

/// A similar pile, and its verdict.
struct Variant {
  double touching = 1;                             ///< factor of the tolerance of contacts: 0.5, 1 or 2
  double friction = 1;                             ///< factor of the coefficients of friction
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of a tilt, unit; zero: none
  double tilt = 0;                                 ///< rad
  Pile pile{};                                     ///< with all of this
  Judgement judgement{};
};

/// `pile`, which has the contacts of a tolerance already, with the friction and the tilt of a variant.
DISMANTLE_API Pile varied(Pile pile, const Variant& variant);

/// Two variants with different certified verdicts: more and less friction, or tilts to both sides, by as little as is
/// enough and at most kMostVaried. Empty: none found. `touching`: the factor that `pile` has.
DISMANTLE_API std::vector<Variant> flips_of(const Pile& pile, double touching = 1,
                                            const std::function<bool()>& stop = {});

/// Empty: each variant has a certificate that holds, none is varied by more than kMostVaried, and the verdicts differ.
/// Piles are those of the variants.
DISMANTLE_API std::string check_flips(const std::vector<Variant>& variants);

/// "with half the tolerance of contacts it stands, with twice it falls".
DISMANTLE_API std::string flips_text(const std::vector<Variant>& variants);

/// Checks the certificate of a verdict. Empty: it holds; otherwise what is wrong.
DISMANTLE_API std::string check_judgement(const Pile& pile, const Judgement& judgement);

}  // namespace dismantle::statics
