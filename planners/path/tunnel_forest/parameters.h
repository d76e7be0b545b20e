/// Parameters of the tunnel_forest path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/motion.h"
#include "dismantle/path/shared_parameters.h"

namespace dismantle::tunnel_forest {

using path::Motion;

struct Parameters {
  Motion motion = Motion::automatic;
  double force = 100;
  double push_time = 0.04;
  std::int64_t tunnels = 20;
  std::int64_t surface_samples = 2'000;
  double join_distance = 3;
  double node_spacing = 1;
  double clearance = 0.01;
  double thinning = 5e-4;
  std::int64_t shortcuts = 100;
  std::int64_t max_refusals = 150;
  std::int64_t level_steps = 20'000;
  double start_bias = 0.5;
  double local_share = 0.4;
  double uniform_share = 0.35;
  std::int64_t tournament = 6;
  double local_range_min = 0.05;
  double local_range_max = 5;
  double range = 2;
  double join_start = 0.5;
  double join_others = 0.05;
  double free_penetration = 0.2;
  double tunnel_width = 1.25;
  double tunnel_neighborhood = 0.25;
  std::int64_t draw_cost = 60;
  std::int64_t extensions_per_tunnel = 100;
  double stall = 0.02;
  std::int64_t idle_pushes = 2;
  double check_spacing = 0.05;
  std::int64_t repairs = 6;
  std::int64_t first_turn = 10'000;
  double new_cells = 0.2;
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
    s.add(
        "push_time", &Parameters::push_time,
        {.unit = "s",
         .min = 1e-3,
         .max = 10,
         .doc = "Duration of a push. Each push is aimed at the target again. Shorter: the part follows obstacles more "
                "closely, but needs more pushes."});
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
    s.add(
        "join_distance", &Parameters::join_distance,
        {.unit = "unit",
         .min = 0,
         .doc =
             "Joins are tried between nodes of different trees up to this distance: that of the centres plus half the "
             "radius times the angle. Larger: more joins are tried, and more of them fail."});
    s.add("node_spacing", &Parameters::node_spacing,
          {.unit = "unit",
           .min = 0.01,
           .max = 100,
           .doc =
               "Longest edge; longer trajectories get nodes in between. Also the scale of the parameters with the unit "
               "`node_spacing`. Smaller: a denser roadmap."});
    s.add(
        "clearance", &Parameters::clearance,
        {.unit = "unit",
         .min = 0,
         .max = 0.01,
         .doc =
             "Distance from contact that a path keeps after retraction, or half of the free width where that is less. "
             "The simulator samples contact, so a path in contact penetrates between the samples and is refused."});
    path::add_thinning(s, &Parameters::thinning);
    s.add("shortcuts", &Parameters::shortcuts,
          {.unit = "1", .min = 0, .max = 100'000, .doc = "Attempts to replace pieces of a path by direct motions."});
    s.add("max_refusals", &Parameters::max_refusals,
          {.unit = "1", .min = 1, .doc = "Paths that the verifier may refuse before the search gives up."});
    path::add_level_steps(s, &Parameters::level_steps);
    describe_growth(s);
    describe_tunnels(s);
    s.add(
        "check_spacing", &Parameters::check_spacing,
        {.unit = "node_spacing",
         .min = 1e-3,
         .max = 1,
         .doc =
             "Advanced. Distance between the state checks along a shortcut. The retracted poses of a path are twice as "
             "far apart. Smaller: fewer paths are refused, each costs more."});
    s.add("repairs", &Parameters::repairs,
          {.unit = "1",
           .min = 0,
           .max = 1000,
           .doc =
               "Advanced. Number of times that a refused path is retracted again after the verifier has reported where "
               "it penetrates."});
    s.add("first_turn", &Parameters::first_turn,
          {.unit = "1",
           .min = 1,
           .max = 1e12,
           .doc = "Advanced. Simulated time steps of the first turn of each forest, with `motion: auto`."});
    s.add(
        "new_cells", &Parameters::new_cells,
        {.unit = "1",
         .min = 0,
         .max = 100,
         .doc = "Advanced. If the explored space of a forest grows by more than this share in a turn, its next turn is "
                "twice as long."});
    s.add("barren_turns", &Parameters::barren_turns,
          {.unit = "1",
           .min = 1,
           .max = 1e6,
           .doc = "Advanced. Number of consecutive turns without any new space after which a forest is exhausted."});
  }

 private:
  static void describe_growth(Schema<Parameters>& s) {
    const auto share = [](const std::string& doc) {
      return ParamTraits{.unit = "1", .min = 0, .max = 1, .doc = "Advanced. " + doc};
    };
    s.add("start_bias", &Parameters::start_bias,
          share("Share of the extensions in the tree of the start; the others are in any tree."));
    s.add("local_share", &Parameters::local_share,
          share("Share of the extensions that slide or turn a node in a sparse region of its tree."));
    s.add("uniform_share", &Parameters::uniform_share,
          share("Share of the extensions towards a uniformly random pose. The rest go towards another node."));
    s.add("tournament", &Parameters::tournament,
          {.unit = "1",
           .min = 1,
           .max = 1000,
           .doc = "Advanced. Random nodes among which a local extension takes the one that is expanded least in the "
                  "sparsest region. Larger: unexplored regions are preferred more strongly."});
    s.add("local_range_min", &Parameters::local_range_min,
          {.unit = "node_spacing",
           .min = 0,
           .max = 100,
           .min_open = true,
           .doc = "Advanced. Shortest local extension; lengths are uniform in their logarithm."});
    s.add(
        "local_range_max", &Parameters::local_range_max,
        {.unit = "node_spacing", .min = 0, .max = 1000, .min_open = true, .doc = "Advanced. Longest local extension."});
    s.add(
        "range", &Parameters::range,
        {.unit = "node_spacing",
         .min = 0,
         .max = 1000,
         .min_open = true,
         .doc = "Advanced. Longest extension towards a random pose or another node. Larger: trees reach far sooner and "
                "fill less of what is near."});
    s.add("join_start", &Parameters::join_start,
          share("Share of the trees near a new node to which a join is tried, when one of the two holds the start."));
    s.add("join_others", &Parameters::join_others, share("The same for two trees that do not hold the start."));
    s.add(
        "stall", &Parameters::stall,
        share("A push that moves the part by less than this share of an unobstructed push is blocked. One that brings "
              "it nearer to the target by less than half of that makes no progress."));
    s.add("idle_pushes", &Parameters::idle_pushes,
          {.unit = "1",
           .min = 1,
           .max = 1000,
           .doc = "Advanced. Number of pushes without progress after which an extension ends. Larger: the part slides "
                  "around more corners, and loses more pushes where it is blocked."});
  }

  static void describe_tunnels(Schema<Parameters>& s) {
    s.add(
        "free_penetration", &Parameters::free_penetration,
        {.unit = "max_penetration",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Penetration up to which a state counts as free, and distance at which a target is reached, "
                "as a share of verify.max_penetration. The final retraction removes it."});
    s.add("tunnel_width", &Parameters::tunnel_width,
          {.unit = "1",
           .min = 0,
           .max = 100,
           .doc = "Advanced. Widest gap that counts as narrow, in median bar widths of the other body."});
    s.add("tunnel_neighborhood", &Parameters::tunnel_neighborhood,
          {.unit = "1",
           .min = 0,
           .max = 100,
           .doc = "Advanced. Fixed parts are searched for narrow places if they are within this share of the moving "
                  "group's size."});
    s.add(
        "draw_cost", &Parameters::draw_cost,
        {.unit = "1",
         .min = 0,
         .max = 1e9,
         .doc =
             "Advanced. Simulated time steps that count for one pose drawn in a tunnel. Tunnels get no more work than "
             "extensions, so larger values mean fewer tunnels."});
    s.add("extensions_per_tunnel", &Parameters::extensions_per_tunnel,
          {.unit = "1", .min = 1, .max = 1e9, .doc = "Advanced. One more tunnel is added after this many extensions."});
  }
};

}  // namespace dismantle::tunnel_forest
