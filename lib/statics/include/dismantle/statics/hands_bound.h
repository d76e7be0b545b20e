/// How many hands any order takes at least, whatever the order, with proof.
///
/// The units of a plan are what is there before its first step, and what each step puts in. The table stays where the
/// finished assembly touches it. Some units are loose: they do not reach the table, and each of them falls although all
/// units that are not loose are there and held, in each orientation that the plan has. In any order of these units one
/// loose unit is the first. It is held until another one supports it, and the next unit takes a hand, too: with two or
/// more loose units some step takes two hands.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/built.h"
#include "dismantle/statics/hold_proof.h"
#include "dismantle/step_check.h"

namespace dismantle::statics {

/// Result of least_hands().
struct HandsBound {
  std::size_t hands = 1;        ///< any order takes as many in some step, the one with the new unit included
  std::vector<PartId> loose{};  ///< the first part of each loose unit, ascending
  std::size_t others = 0;       ///< units that are not loose
  /// "loose": numbers of units, which are in ascending order of their first parts; "falls": for each, and for each
  /// orientation of the plan in ascending order, a motion of falling as in hold_proof.h. Empty: one hand.
  Numbers numbers{};
};

/// `operations`: of a plan, in the order of assembly. One hand, too, if they do not build one group in place.
DISMANTLE_API HandsBound least_hands(const BuiltPiles& piles, std::span<const StepQuestion> operations);

/// Checks the numbers of a bound of two hands without the solver. Empty: they hold; otherwise what is wrong.
DISMANTLE_API std::string check_least_hands(const BuiltPiles& piles, std::span<const StepQuestion> operations,
                                            const Numbers& numbers);

}  // namespace dismantle::statics
