/// What no order of the motions of a segment can do without.
#pragma once

#include "best_order/segment.h"

namespace dismantle::order {

/// No order of the segment costs less, whatever the checks say that read what is there, or the path, or the shape of
/// the last step, and whatever others estimate: each unit costs at least its cheapest motion, and each change of the
/// direction that no order can do without at least what the cheapest one costs. May use up the tests of pairs.
/// \throws CheckFailed
double least_cost(Segment& segment, const SequenceQuery& query, RunContext& context, Effort& effort);

}  // namespace dismantle::order
