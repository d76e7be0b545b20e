/// Parameters of the search along a navigation function. The navigation_tree path planner declares them.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "dismantle/tolerant_walk/parameters.h"

namespace dismantle::free_space {

struct GridParameters {
  std::int64_t cells = 500'000;
  std::int64_t wall_cost = 36;
  double blocked_length = 120;
};

struct SearchParameters : tolerant_walk::TreeParameters, GridParameters {
  std::int64_t control_points = 24;
  double descent_bias = 0.7;
  double slippage_bias = 0.2;
  double uniform_weights = 0.4;
  double best_bias = 0.6;
  double projection_cell = 0.15;
  double visits_per_step = 3;
  double max_work = 12;
  std::int64_t play_checks = 100;
  double play = 0.02;
  double play_of_thin = 0.05;
  double min_progress = 0.15;

  SearchParameters() {
    first_step_max = 2;
    step_growth = 1.25;
    extension_steps = 200;
  }
};

/// Declares the limits of the search.
template <class P>
void describe_effort(Schema<P>& s) {
  using path::inherited;
  s.add("max_work", inherited<P>(&SearchParameters::max_work),
        {.unit = "patience",
         .min = 1,
         .max = 1e6,
         .doc = "Advanced. Work of the whole search, in multiples of `patience`. Larger: a search that keeps making "
                "progress may go on for longer."});
  s.add("play_checks", inherited<P>(&SearchParameters::play_checks),
        {.unit = "1",
         .min = 1,
         .max = 1e9,
         .doc = "Advanced. After this many state checks the search ends if the group has come no further than `play`. "
                "Smaller: groups that are held cost less, but a hidden narrow exit is missed more often."});
  s.add("play", inherited<P>(&SearchParameters::play),
        {.unit = "radius",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Progress along the route, in radii of the group, up to which it counts as mere play."});
  s.add("play_of_thin", inherited<P>(&SearchParameters::play_of_thin),
        {.unit = "radius",
         .min = 0,
         .max = 1,
         .doc = "Advanced. A group thinner than its initial overlap is not held if its displacement exceeds this, in "
                "radii of the group, however little progress it has made."});
  s.add(
      "min_progress", inherited<P>(&SearchParameters::min_progress),
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "Advanced. Progress that the search must have made before it takes detours: this share of the route, or "
              "one diameter of the group if that is less. Larger: it gives up sooner."});
}

/// Declares the parameters of the grid.
template <class P>
void describe_grid(Schema<P>& s) {
  using path::inherited;
  s.add("cells", inherited<P>(&GridParameters::cells),
        {.unit = "1",
         .min = 1000,
         .max = 1e8,
         .doc = "Largest number of cells of the grid over the box of the fixed parts. More: narrower gaps are "
                "found; time and memory grow in proportion."});
  s.add("wall_cost", inherited<P>(&GridParameters::wall_cost),
        {.unit = "cell",
         .min = 0,
         .max = 1000,
         .doc = "Advanced. Additional cost of a cell beside a wall; at twice the distance a quarter of it. Larger: "
                "routes make longer detours through wide places."});
  s.add("blocked_length", inherited<P>(&GridParameters::blocked_length),
        {.unit = "cell",
         .min = 1,
         .max = 1e6,
         .doc = "Advanced. Additional length of a route for each cell from inside a wall to the nearest free cell. "
                "Larger: control points leave walls before they follow the route."});
}

/// Declares how the tree grows.
template <class P>
void describe_growth(Schema<P>& s) {
  using path::inherited;
  s.add("control_points", inherited<P>(&SearchParameters::control_points),
        {.unit = "1",
         .min = 4,
         .max = 1000,
         .doc = "Advanced. Points of the group at which the navigation function is evaluated, at least four for each "
                "part. More: bodies of intricate shape are guided better, but each step costs more."});
  s.add("descent_bias", inherited<P>(&SearchParameters::descent_bias),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the extensions that descend the navigation function; the others are random. "
                "Smaller: more exploration."});
  s.add("slippage_bias", inherited<P>(&SearchParameters::slippage_bias),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the extensions along a slippable motion of the part, if it has one: the screw of a "
                "spring, the axis of a pin. `descent_bias` divides the rest."});
  s.add("uniform_weights", inherited<P>(&SearchParameters::uniform_weights),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the descents in which all control points weigh the same. In the others those near "
                "a random one weigh more, so that one end of the part leads."});
  s.add("best_bias", inherited<P>(&SearchParameters::best_bias),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the extensions from the best node of the selected projection cell; the others "
                "start from any node of it."});
  s.add("projection_cell", inherited<P>(&SearchParameters::projection_cell),
        {.unit = "radius",
         .min = 0,
         .max = 10,
         .doc = "Advanced. Edge of the cells by which poses are grouped, in radii of the group; at least two longest "
                "steps. Larger: fewer groups, more exploitation."});
  s.add("visits_per_step", inherited<P>(&SearchParameters::visits_per_step),
        {.unit = "1",
         .min = 0,
         .max = 1e6,
         .min_open = true,
         .doc = "Advanced. Number of visits of a projection cell that weigh as much as one longest step along the "
                "route. Larger: the search stays longer at the poses that have come furthest."});
}

}  // namespace dismantle::free_space
