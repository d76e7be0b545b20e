/// Proof of the least holds of a pile, as the numbers of a plan file, and its check without the solver.
///
/// That the pile stands with its holds is shown by a displacement: each contact point is a spring, its force the
/// projection of the elastic force on the friction cone, and these forces are in equilibrium (spring_forces()). That
/// fewer holds do not suffice is shown by motions of falling: one body of each must be held.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Numbers by name, as in a Certificate.
using Numbers = std::map<std::string, std::vector<double>>;

/// The proof itself. Motions are of all bodies of the pile.
struct HoldProof {
  std::vector<std::uint32_t> held{};  ///< bodies, ascending
  Motions displacement{};             ///< with `held` fixed
  std::vector<Motions> falls{};       ///< with nothing held; no smaller set than `held` meets all of them
};

/// Adds "STATE.held", "STATE.displacement" (six numbers for each body that is neither fixed nor held) and "STATE.falls"
/// (for each motion how many bodies move, and seven numbers for each: body, v, w).
DISMANTLE_API void add_hold_proof(const HoldProof& proof, const Pile& pile, const std::string& state, Numbers& numbers);
/// Reads what add_hold_proof() wrote; none: the numbers are not of this form.
DISMANTLE_API std::optional<HoldProof> hold_proof_in(const Numbers& numbers, const std::string& state,
                                                     const Pile& pile);
/// Appends a motion as in "STATE.falls".
DISMANTLE_API void add_fall(const Motions& motion, std::vector<double>& to);
/// Reads the motion at `at`, of a pile of so many bodies, and steps behind it. None: there is no such motion.
DISMANTLE_API std::optional<Motions> fall_at(const std::vector<double>& from, std::size_t& at, std::size_t bodies);
/// Empty: the pile stands with its holds, and no fewer suffice; otherwise what is wrong.
DISMANTLE_API std::string check_hold_proof(const Pile& pile, const HoldProof& proof);

}  // namespace dismantle::statics
