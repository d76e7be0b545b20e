/// Parameters of the bk_rrt path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/search/motion.h"
#include "dismantle/search/shared_parameters.h"

namespace dismantle::bk_rrt {

using path::Motion;
enum class Actions { sphere, axes };

struct Parameters {
  Motion motion = Motion::automatic;
  // Table 6.
  double time_step = 0.1;
  double force = 100;
  // Where Algorithm 4 leaves a choice; see README.md.
  Actions actions = Actions::sphere;
  /// Poses that the rest of the path reproduces to within this distance are dropped (assembly units).
  double thinning = 1e-4;
  std::int64_t level_steps = 20'000;
  /// Simulated time steps of the first turn of each tree, with `motion: auto`. Each round doubles them.
  std::int64_t first_turn = 4'000;

  static void describe(Schema<Parameters>& s) {
    s.add_choice<Motion>("motion", &Parameters::motion,
                         {{"translation", Motion::translation, "forces, orientation locked"},
                          {"rotation", Motion::rotation, "forces and torques in SE(3)"},
                          {"auto", Motion::automatic, "a tree of each kind; they grow in turns"}},
                         "State space of the search.");
    s.add("time_step", &Parameters::time_step,
          {.unit = "s",
           .min = 1e-3,
           .max = 10,
           .doc = "Planning time step: duration of a random action (table 6). Longer: larger extensions, but more of "
                  "them end at an obstacle."});
    s.add("force", &Parameters::force,
          {.unit = "N",
           .min = 0,
           .min_open = true,
           .doc = "Force of each action. The torque is the force times the part's radius (table 6)."});
    s.add_choice<Actions>(
        "actions", &Parameters::actions,
        {{"sphere", Actions::sphere, "any direction, uniformly; with rotation any wrench of that size"},
         {"axes", Actions::axes, "one of the 6 (with rotation 12) unit actions of bfs"}},
        "Distribution of random actions.");
    s.advanced("thinning", &Parameters::thinning, {0, 0.01});
    path::add_level_steps(s, &Parameters::level_steps);
    s.advanced("first_turn", &Parameters::first_turn, {1, 1e12});
  }
};

}  // namespace dismantle::bk_rrt
