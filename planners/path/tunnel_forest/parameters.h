/// Parameters of the tunnel_forest path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/motion.h"

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

  static void describe(Schema<Parameters>& s) {
    s.add_choice<Motion>("motion", &Parameters::motion,
                         {{"translation", Motion::translation, "orientation locked"},
                          {"rotation", Motion::rotation, "SE(3)"},
                          {"auto", Motion::automatic, "a forest of each kind, which grow in turn"}},
                         "State space of the search.");
    s.add("force", &Parameters::force,
          {.unit = "N",
           .min = 0,
           .min_open = true,
           .doc = "Force of a push; torques are this times the part's torque arm."});
    s.add("push_time", &Parameters::push_time,
          {.unit = "s",
           .min = 1e-3,
           .max = 10,
           .doc = "Length of a push. Before the next one it is aimed at the target anew."});
    s.add("tunnels", &Parameters::tunnels,
          {.unit = "1",
           .min = 0,
           .max = 1000,
           .doc = "Trees to begin with in poses where narrow places of the parts match; more are added while the "
                  "search goes on. 0: none at all, only the tree at the start grows."});
    s.add(
        "surface_samples", &Parameters::surface_samples,
        {.unit = "1", .min = 1, .max = 1e6, .doc = "Surface points of each side at which gaps and bars are measured."});
    s.add(
        "join_distance", &Parameters::join_distance,
        {.unit = "unit",
         .min = 0,
         .doc = "Nodes of two trees that are no further apart (way of the centre plus half the radius times the angle) "
                "may be joined."});
    s.add("node_spacing", &Parameters::node_spacing,
          {.unit = "unit", .min = 0.01, .max = 100, .doc = "A way that is longer gets nodes in between."});
    s.add(
        "clearance", &Parameters::clearance,
        {.unit = "unit",
         .min = 0,
         .max = 0.01,
         .doc = "What a path keeps from contact, or half of the room there is: contact is sampled, and the verifier is "
                "not."});
    s.add("thinning", &Parameters::thinning,
          {.unit = "unit",
           .min = 0,
           .max = 0.01,
           .doc = "Poses that the rest of the path reproduces this closely are dropped."});
    s.add(
        "shortcuts", &Parameters::shortcuts,
        {.unit = "1", .min = 0, .max = 100'000, .doc = "Straight motions tried in place of parts of the path found."});
    s.add("max_refusals", &Parameters::max_refusals,
          {.unit = "1", .min = 1, .doc = "Paths that the verifier may refuse before the search gives up."});
    s.add("level_steps", &Parameters::level_steps,
          {.unit = "1",
           .min = 1,
           .doc = "Simulated time steps for a search of depth 1 where the sequence planner limits depth; each further "
                  "level doubles them."});
  }
};

}  // namespace dismantle::tunnel_forest
