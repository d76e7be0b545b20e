/// Parameters of the search along a navigation function. The navigation_tree path planner declares them.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "dismantle/tolerant_walk/parameters.h"

namespace dismantle::free_space {

struct GridParameters {
  std::int64_t cells = 500'000;
  /// Additional cost of a cell beside a wall; at twice the distance a quarter of it. Larger: routes make longer detours
  /// through wide places.
  std::int64_t wall_cost = 36;
  /// Additional length of a route for each cell from inside a wall to the nearest free cell. Larger: control points
  /// leave walls before they follow the route.
  double blocked_length = 120;
};

struct SearchParameters : tolerant_walk::TreeParameters, GridParameters {
  /// Points of the group at which the navigation function is evaluated, at least four for each part. More: bodies of
  /// intricate shape are guided better, but each step costs more.
  std::int64_t control_points = 24;
  /// Share of the extensions that descend the navigation function; the others are random. Smaller: more exploration.
  double descent_bias = 0.7;
  /// Share of the extensions along a slippable motion of the part, if it has one: the screw of a spring, the axis of a
  /// pin. `descent_bias` divides the rest.
  double slippage_bias = 0.2;
  /// Share of the descents in which all control points weigh the same. In the others those near a random one weigh
  /// more, so that one end of the part leads.
  double uniform_weights = 0.4;
  /// Share of the extensions from the best node of the selected projection cell; the others start from any node of it.
  double best_bias = 0.6;
  /// Edge of the cells by which poses are grouped, in radii of the group; at least two longest steps. Larger: fewer
  /// groups, more exploitation.
  double projection_cell = 0.15;
  /// Number of visits of a projection cell that weigh as much as one longest step along the route. Larger: the search
  /// stays longer at the poses that have come furthest.
  double visits_per_step = 3;
  /// Work of the whole search, in multiples of `patience`. Larger: a search that keeps making progress may go on for
  /// longer.
  double max_work = 12;
  /// After this many state checks the search ends if the group has come no further than `play`. Smaller: groups that
  /// are held cost less, but a hidden narrow exit is missed more often.
  std::int64_t play_checks = 100;
  /// Progress along the route, in radii of the group, up to which it counts as mere play.
  double play = 0.02;
  /// A group thinner than its initial overlap is not held if its displacement exceeds this, in radii of the group,
  /// however little progress it has made.
  double play_of_thin = 0.05;
  /// Progress that the search must have made before it takes detours: this share of the route, or one diameter of the
  /// group if that is less. Larger: it gives up sooner.
  double min_progress = 0.15;

  SearchParameters() {
    first_step_max = 2;
    step_growth = 1.25;
    extension_steps = 200;
  }
};

/// Declares the parameters of a struct that derives from SearchParameters.
template <class P>
void describe_search(Schema<P>& s) {
  tolerant_walk::describe_tree(s);
  s.advanced("max_work", &SearchParameters::max_work, {1, 1e6});
  s.advanced("play_checks", &SearchParameters::play_checks, {1, 1e9});
  s.advanced("play", &SearchParameters::play, {0, 1});
  s.advanced("play_of_thin", &SearchParameters::play_of_thin, {0, 1});
  s.advanced("min_progress", &SearchParameters::min_progress, {0, 1});
  s.add("cells", &GridParameters::cells,
        {.unit = "1",
         .min = 1000,
         .max = 1e8,
         .doc = "Largest number of cells of the grid over the box of the fixed parts. More: narrower gaps are "
                "found; time and memory grow in proportion."});
  s.advanced("wall_cost", &GridParameters::wall_cost, {0, 1000});
  s.advanced("blocked_length", &GridParameters::blocked_length, {1, 1e6});
  s.advanced("control_points", &SearchParameters::control_points, {4, 1000});
  s.advanced("descent_bias", &SearchParameters::descent_bias, {0, 1});
  s.advanced("slippage_bias", &SearchParameters::slippage_bias, {0, 1});
  s.advanced("uniform_weights", &SearchParameters::uniform_weights, {0, 1});
  s.advanced("best_bias", &SearchParameters::best_bias, {0, 1});
  s.advanced("projection_cell", &SearchParameters::projection_cell, {0, 10});
  s.advanced("visits_per_step", &SearchParameters::visits_per_step, {.min = 0, .max = 1e6, .min_open = true});
}

}  // namespace dismantle::free_space
