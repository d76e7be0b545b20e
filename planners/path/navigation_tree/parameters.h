/// Parameters of the navigation_tree path planner.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "dismantle/tolerant_walk/parameters.h"

namespace dismantle::navigation_tree {

struct Parameters : tolerant_walk::TreeParameters {
  std::int64_t patience = 4'000;
  std::int64_t detours = 8;
  std::int64_t full_depth = 3;
  std::int64_t cells = 500'000;
  std::int64_t max_refusals_overlapping = 3;

  static void describe(Schema<Parameters>& s) {
    tolerant_walk::describe_poses(s, "How far a point of the part moves in a first step, about.");
    s.add(
        "patience", &Parameters::patience,
        {.unit = "1",
         .min = 0,
         .max = 1e12,
         .doc = "State checks without progress after which the narrowest place ahead is taken for closed; 12 times as "
                "many in all. One counts as the number of its distance queries in thousands, a quarter at least. 0: "
                "nothing is searched."});
    s.add("detours", &Parameters::detours,
          {.unit = "1", .min = 0, .max = 1000, .doc = "Places that may be taken for closed before it gives up."});
    s.add(
        "full_depth", &Parameters::full_depth,
        {.unit = "1",
         .min = 0,
         .max = 64,
         .doc = "Under a depth limit below this, `patience` and `detours` are halved for each level that is missing."});
    s.add("cells", &Parameters::cells,
          {.unit = "1",
           .min = 1000,
           .max = 1e8,
           .doc = "About this many cells are laid over the box of the fixed parts to find free space."});
    tolerant_walk::describe_paths(s);
    s.add(
        "max_refusals_overlapping", &Parameters::max_refusals_overlapping,
        {.unit = "1",
         .min = 1,
         .max = 1e6,
         .doc = "The same in the second search for a group that is thinner than its initial overlap: the one in which "
                "that overlap is allowed everywhere, so that paths may lead through walls."});
  }

  /// Of the tree. `overlapping`: in the second search of a thin group.
  tolerant_walk::TreeParameters tree(bool overlapping) const {
    tolerant_walk::TreeParameters p = *this;
    if (overlapping) p.max_refusals = max_refusals_overlapping;
    return p;
  }
};

}  // namespace dismantle::navigation_tree
