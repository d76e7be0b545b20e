/// What a screw calls for by the order in which it is tightened.
#pragma once

#include <optional>
#include <span>

#include "dismantle/simulator.h"
#include "dismantle/step_note.h"
#include "fastener_memo.h"

namespace dismantle::checks {

/// The screw is tightened while a part that it clamps is not there; it has to be loosened again.
std::optional<StepNote> early_note(const FastenerMemo& memo, std::span<const PlacedPart> there, PartId screw);

/// The nut is put in although its screw is not there.
StepNote early_nut_note(const FastenerMemo& memo, PartId nut, PartId screw);

/// The screw is the first of its pattern that is tightened. `present`: the parts that were there before.
std::optional<StepNote> pattern_note(const FastenerMemo& memo, std::span<const PlacedPart> present, PartId screw);

}  // namespace dismantle::checks
