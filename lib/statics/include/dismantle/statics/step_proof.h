/// Proofs of holds of an assembly step: which states it has, and their check.
///
/// After the step: "after"; while the part is pressed in or pulled back: "during"; when the whole is turned before the
/// step: "turning". The numbers of a step are those of hold_proof.h for each state that is proved, "STATE.gaps" (0:
/// tight, 1: play) and "during.push" (signed; times the weight of the part, along its path; 0: the state before the
/// step).
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/statics/built.h"
#include "dismantle/statics/hold_proof.h"
#include "dismantle/step_check.h"

namespace dismantle::statics {

inline constexpr double kHandPush = 2;  ///< times its weight: what a hand presses a part in with

/// Both, in ascending order of ids.
DISMANTLE_API std::vector<PlacedPart> joined(std::span<const PlacedPart> a, std::span<const PlacedPart> b);

/// The parts where they are assembled, if all are only translated from there, and by the same; else as they are. Where
/// a pile stands says nothing: a verdict that rounding decides must be the same in a plan and in its check.
DISMANTLE_API std::vector<PlacedPart> where_assembled(std::vector<PlacedPart> parts);

/// An orientation halfway between two; over one side, always the same one, if they are opposite.
DISMANTLE_API Eigen::Vector3d up_while_turned(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// What the proofs of a step say, if they hold.
struct StepHolds {
  std::string wrong{};                                           ///< empty: all proofs hold
  std::map<std::string, std::vector<std::vector<PartId>>> held;  ///< by state: the parts of each body that is held
};

/// Checks the proofs of a step without the solver; the contacts are found again.
DISMANTLE_API StepHolds check_step_proof(const BuiltPiles& piles, const StepQuestion& question, const Numbers& numbers);

}  // namespace dismantle::statics
