/// Declarations of parameters that several planners have.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::path {

/// Converts a member pointer of a base class to one of P, as Schema<P> needs: template deduction does not convert it.
template <class P, class Base, class M>
constexpr M P::*inherited(M Base::*member) {
  return member;
}

template <class P>
void add_thinning(Schema<P>& s, double P::*member) {
  s.add("thinning", member,
        {.unit = "unit",
         .min = 0,
         .max = 0.01,
         .doc = "Poses that the rest of the path reproduces to within this distance are dropped."});
}

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
