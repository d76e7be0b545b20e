/// Overlaps that usual models of fits have.
#pragma once

#include "dismantle/preparation/check_assembly.h"
#include "dismantle/verification/contact.h"

namespace dismantle {

/// Makes `finding`, an overlap, a note if it is that of a screw without a thread, or slight for the size of the parts.
void excuse_usual_overlap(const Assembly& assembly, const InitialOverlap& pair, const PairContact& found,
                          Finding& finding);

/// One line for findings that are alike: how many pairs, how deep at most.
std::string together_text(const std::vector<const Finding*>& findings);

}  // namespace dismantle
