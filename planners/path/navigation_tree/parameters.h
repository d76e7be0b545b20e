/// Parameters of the navigation_tree path planner.
#pragma once

#include <cstdint>

#include "dismantle/free_space/parameters.h"
#include "dismantle/parameters.h"

namespace dismantle::navigation_tree {

struct Parameters : free_space::SearchParameters {
  std::int64_t patience = 4'000;
  std::int64_t detours = 8;
  /// Under a depth limit below this, `patience` and `detours` are halved for each missing level.
  std::int64_t full_depth = 3;
  /// `max_refusals` of the second search for a group that is thinner than its initial overlap. That search allows the
  /// overlap everywhere, so its paths may lead through walls.
  std::int64_t max_refusals_overlapping = 3;

  static void describe(Schema<Parameters>& s) {
    free_space::describe_search(s);
    s.add(
        "patience", &Parameters::patience,
        {.unit = "1",
         .min = 0,
         .max = 1e12,
         .doc = "State checks without progress after which the narrowest place ahead is blocked. A state check counts "
                "once for each 1000 distance queries that it makes, and at least a quarter. Larger: more parts are "
                "removed, but parts that cannot be removed cost more. 0: no search."});
    s.add("detours", &Parameters::detours,
          {.unit = "1",
           .min = 0,
           .max = 1000,
           .doc = "Places that may be blocked before the search gives up. Larger: more routes are tried."});
    s.advanced("full_depth", &Parameters::full_depth, {0, 64});
    s.advanced("max_refusals_overlapping", &Parameters::max_refusals_overlapping, {1, 1e6});
  }

  /// `overlapping`: for the second search of a thin group.
  free_space::SearchParameters search(bool overlapping) const {
    free_space::SearchParameters p = *this;
    if (overlapping) p.max_refusals = max_refusals_overlapping;
    return p;
  }
};

}  // namespace dismantle::navigation_tree
