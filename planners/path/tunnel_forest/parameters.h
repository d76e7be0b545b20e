/// Parameters of the tunnel_forest path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/search/motion.h"
#include "dismantle/search/shared_parameters.h"

namespace dismantle::tunnel_forest {

using path::Motion;

struct Parameters {
  Motion motion = Motion::automatic;
  double force = 100;
  /// Duration of a push. Each push is aimed at the target again. Shorter: the part follows obstacles more closely, but
  /// needs more pushes.
  double push_time = 0.04;
  std::int64_t tunnels = 20;
  std::int64_t surface_samples = 2'000;
  /// Joins are tried between nodes of different trees up to this distance: that of the centres plus half the radius
  /// times the angle. Larger: more joins are tried, and more of them fail (assembly units).
  double join_distance = 3;
  /// Longest edge; longer trajectories get nodes in between. Also the scale of the parameters with the unit
  /// `node_spacing`. Smaller: a denser roadmap.
  double node_spacing = 1;
  /// Distance from contact that a path keeps after retraction, or half of the free width where that is less. The
  /// simulator samples contact, so a path in contact penetrates between the samples and is refused (assembly units).
  double clearance = 0.01;
  /// Poses that the rest of the path reproduces to within this distance are dropped (assembly units).
  double thinning = 5e-4;
  std::int64_t shortcuts = 100;     ///< Attempts to replace pieces of a path by direct motions.
  std::int64_t max_refusals = 150;  ///< Paths that the verifier may refuse before the search gives up.
  std::int64_t level_steps = 20'000;
  double start_bias = 0.5;   ///< Share of the extensions in the tree of the start; the others are in any tree.
  double local_share = 0.4;  ///< Share of the extensions that slide or turn a node in a sparse region of its tree.
  /// Share of the extensions towards a uniformly random pose. The rest go towards another node.
  double uniform_share = 0.35;
  /// Random nodes among which a local extension takes the one that is expanded least in the sparsest region. Larger:
  /// unexplored regions are preferred more strongly.
  std::int64_t tournament = 6;
  /// Shortest local extension; lengths are uniform in their logarithm, in multiples of `node_spacing`.
  double local_range_min = 0.05;
  double local_range_max = 5;  ///< Longest local extension, in multiples of `node_spacing`.
  /// Longest extension towards a random pose or another node. Larger: trees reach far sooner and fill less of what is
  /// near, in multiples of `node_spacing`.
  double range = 2;
  /// Share of the trees near a new node to which a join is tried, when one of the two holds the start.
  double join_start = 0.5;
  double join_others = 0.05;  ///< The same for two trees that do not hold the start.
  /// Penetration up to which a state counts as free, and distance at which a target is reached, as a share of
  /// verify.max_penetration. The final retraction removes it.
  double free_penetration = 0.2;
  double tunnel_width = 1.25;  ///< Widest gap that counts as narrow, in median bar widths of the other body.
  /// Fixed parts are searched for narrow places if they are within this share of the moving group's size.
  double tunnel_neighborhood = 0.25;
  /// Simulated time steps that count for one pose drawn in a tunnel. Tunnels get no more work than extensions, so
  /// larger values mean fewer tunnels.
  std::int64_t draw_cost = 60;
  std::int64_t extensions_per_tunnel = 100;  ///< One more tunnel is added after this many extensions.
  /// A push that moves the part by less than this share of an unobstructed push is blocked. One that brings it nearer
  /// to the target by less than half of that makes no progress.
  double stall = 0.02;
  /// Number of pushes without progress after which an extension ends. Larger: the part slides around more corners, and
  /// loses more pushes where it is blocked.
  std::int64_t idle_pushes = 2;
  /// Distance between the state checks along a shortcut. The retracted poses of a path are twice as far apart. Smaller:
  /// fewer paths are refused, each costs more, in multiples of `node_spacing`.
  double check_spacing = 0.05;
  /// Number of times that a refused path is retracted again after the verifier has reported where it penetrates.
  std::int64_t repairs = 6;
  std::int64_t first_turn = 10'000;  ///< Simulated time steps of the first turn of each forest, with `motion: auto`.
  /// If the explored space of a forest grows by more than this share in a turn, its next turn is twice as long.
  double new_cells = 0.2;
  /// Number of consecutive turns without any new space after which a forest is exhausted.
  std::int64_t barren_turns = 3;

  static void describe(Schema<Parameters>& s) {
    s.add_choice<Motion>("motion", &Parameters::motion,
                         {{"translation", Motion::translation, "orientation locked"},
                          {"rotation", Motion::rotation, "SE(3)"},
                          {"auto", Motion::automatic, "a forest of each kind; they grow in turns"}},
                         "State space of the search.");
    s.add("force", &Parameters::force,
          {.unit = "N",
           .min = 0,
           .min_open = true,
           .doc = "Force of a push. The torque is the force times the part's torque arm."});
    s.advanced("push_time", &Parameters::push_time, {1e-3, 10});
    s.add(
        "tunnels", &Parameters::tunnels,
        {.unit = "1",
         .min = 0,
         .max = 1000,
         .doc =
             "Number of trees at the beginning whose roots are poses where narrow places of the parts match. More are "
             "added during the search (`extensions_per_tunnel`). 0: only the tree at the start grows."});
    s.add(
        "surface_samples", &Parameters::surface_samples,
        {.unit = "1",
         .min = 1,
         .max = 1e6,
         .doc =
             "Number of surface points of the moving and of the fixed parts at which gaps and bars are measured. More: "
             "smaller narrow places are found."});
    s.advanced("join_distance", &Parameters::join_distance, {0});
    s.advanced("node_spacing", &Parameters::node_spacing, {0.01, 100});
    s.advanced("clearance", &Parameters::clearance, {0, 0.01});
    s.advanced("thinning", &Parameters::thinning, {0, 0.01});
    s.advanced("shortcuts", &Parameters::shortcuts, {0, 100'000});
    s.advanced("max_refusals", &Parameters::max_refusals, {1});
    path::add_level_steps(s, &Parameters::level_steps);
    s.advanced("check_spacing", &Parameters::check_spacing, {1e-3, 1});
    s.advanced("repairs", &Parameters::repairs, {0, 1000});
    s.advanced("first_turn", &Parameters::first_turn, {1, 1e12});
    s.advanced("new_cells", &Parameters::new_cells, {0, 100});
    s.advanced("barren_turns", &Parameters::barren_turns, {1, 1e6});
    s.advanced("start_bias", &Parameters::start_bias, {0, 1});
    s.advanced("local_share", &Parameters::local_share, {0, 1});
    s.advanced("uniform_share", &Parameters::uniform_share, {0, 1});
    s.advanced("tournament", &Parameters::tournament, {1, 1000});
    s.advanced("local_range_min", &Parameters::local_range_min, {.min = 0, .max = 100, .min_open = true});
    s.advanced("local_range_max", &Parameters::local_range_max, {.min = 0, .max = 1000, .min_open = true});
    s.advanced("range", &Parameters::range, {.min = 0, .max = 1000, .min_open = true});
    s.advanced("join_start", &Parameters::join_start, {0, 1});
    s.advanced("join_others", &Parameters::join_others, {0, 1});
    s.advanced("stall", &Parameters::stall, {0, 1});
    s.advanced("idle_pushes", &Parameters::idle_pushes, {1, 1000});
    s.advanced("free_penetration", &Parameters::free_penetration, {0, 1});
    s.advanced("tunnel_width", &Parameters::tunnel_width, {0, 100});
    s.advanced("tunnel_neighborhood", &Parameters::tunnel_neighborhood, {0, 100});
    s.advanced("draw_cost", &Parameters::draw_cost, {0, 1e9});
    s.advanced("extensions_per_tunnel", &Parameters::extensions_per_tunnel, {1, 1e9});
  }
};

}  // namespace dismantle::tunnel_forest
