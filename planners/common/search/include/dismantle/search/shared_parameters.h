/// Declarations of parameters that several planners have.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::path {

/// Each planner sets its own default.
template <class P>
void add_level_steps(Schema<P>& s, std::int64_t P::*member) {
  s.add("level_steps", member,
        {.unit = "1",
         .min = 1,
         .doc = "Limit of simulated time steps at depth 1 when the sequence planner limits the depth. Each further "
                "level doubles the limit."});
}

}  // namespace dismantle::path
