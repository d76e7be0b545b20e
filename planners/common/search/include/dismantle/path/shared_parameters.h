/// Declarations of parameters that several planners have.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::path {

/// A member that P has from a base class, as Schema<P> wants it: C++ does not convert it where a template is deduced.
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
         .doc = "Poses that the rest of the path reproduces this closely are dropped."});
}

/// The default is the planner's own.
template <class P>
void add_level_steps(Schema<P>& s, std::int64_t P::*member) {
  s.add("level_steps", member,
        {.unit = "1",
         .min = 1,
         .doc = "Simulated time steps for a search of depth 1 where the sequence planner limits depth; each further "
                "level doubles them."});
}

}  // namespace dismantle::path
