/// Parameters of the sdf_penalty simulator.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "dismantle/sdf/contact_scene.h"
#include "dismantle/sdf/field_parameters.h"

namespace dismantle::sdf_penalty {

enum class Dynamics {
  quasi_static,  ///< no inertia, viscous drag: a part moves along the force and stops when the force ends
  unit_mass,     ///< second order, every part has mass 1
  density,       ///< second order, mass = density * volume: the paper's text
  acceleration,  ///< second order, a wrench is an acceleration: the same for every part
};

struct Parameters : sdf::ContactParameters {
  // Table 5.
  double contact_stiffness = 1e6;
  double contact_damping = 0;
  double time_step = 1e-3;
  // Table 6; in the paper every contact yields by 0.01 before it resists.
  double contact_threshold = 0;
  Dynamics dynamics = Dynamics::quasi_static;
  double density = 1;
  double drag = 40;
  /// Largest motion of any point of a part in one implicit step; bounds speed and keeps parts from passing thin walls
  /// (assembly units).
  double max_travel = 0.02;
  /// Second order: combines time steps into one as long as no point moves further than `max_travel`.
  bool adaptive = false;
  /// Second order: an advance ends when its rest cannot move the part further than this share of the motion of a free
  /// part. 0: all time steps are simulated.
  double rest_share = 0;
  /// A part that moves by less than this share of the free way has stalled; under `dynamics: quasi_static` the advance
  /// ends after three such steps.
  double stall_share = 0.1;
  sdf::DistanceModel distance = sdf::DistanceModel::exact;
  double cell = 0.05;
  /// Smallest number of cells along each edge of the part's box under `distance: grid` (appendix A).
  std::int64_t cells_per_edge = 20;

  static void describe(Schema<Parameters>& s) {
    s.add("contact_stiffness", &Parameters::contact_stiffness,
          {.unit = "N/unit",
           .min = 0,
           .min_open = true,
           .doc = "Penalty stiffness k_n of each contact point (table 5)."});
    s.add("contact_damping", &Parameters::contact_damping,
          {.unit = "N s/unit^2", .min = 0, .doc = "Contact damping k_d of equation (1) (table 5)."});
    s.add(
        "time_step", &Parameters::time_step,
        {.unit = "s", .min = 1e-6, .max = 0.1, .doc = "Simulation time step (table 5) of the second-order dynamics."});
    s.add("contact_threshold", &Parameters::contact_threshold,
          {.unit = "unit",
           .min = 0,
           .max = 0.1,
           .doc = "Depth at which contact begins to resist, on top of the pair's initial overlap (0.01 in table 6; the "
                  "verifier must allow the same depth)."});
    s.add_choice<Dynamics>("dynamics", &Parameters::dynamics,
                           {{"quasi_static", Dynamics::quasi_static,
                             "no inertia, viscous drag: speed does not depend on the part's mass or history"},
                            {"unit_mass", Dynamics::unit_mass, "second order, every part has mass 1"},
                            {"density", Dynamics::density, "second order, mass from volume: as the paper writes"},
                            {"acceleration", Dynamics::acceleration,
                             "second order, forces are linear and torques angular accelerations (unit/s^2, rad/s^2), "
                             "whatever the part's mass and inertia: as the code published with the paper moves parts"}},
                           "How forces become motion.");
    s.add("density", &Parameters::density,
          {.unit = "kg/unit^3", .min = 0, .min_open = true, .doc = "Density of all parts under `dynamics: density`."});
    s.add("drag", &Parameters::drag,
          {.unit = "N s/unit",
           .min = 0,
           .min_open = true,
           .doc = "Drag under `dynamics: quasi_static`: a free part moves at force / drag."});
    s.advanced("max_travel", &Parameters::max_travel, {1e-4, 0.1});
    s.advanced("adaptive", &Parameters::adaptive);
    s.advanced("rest_share", &Parameters::rest_share, {0, 0.1});
    s.add_choice<sdf::DistanceModel>(
        "distance", &Parameters::distance,
        {{"exact", sdf::DistanceModel::exact,
          "closest triangle near the surface, a coarse grid of exact distances far away"},
         {"grid", sdf::DistanceModel::grid, "trilinear grid everywhere: the paper's, blind below a cell"}},
        "Where contact takes its distances from.");
    s.add("cell", &Parameters::cell,
          {.unit = "unit",
           .min = 1e-3,
           .max = 1,
           .doc = "Largest cell of the distance field under `distance: grid` (appendix A)."});
    s.advanced("cells_per_edge", &Parameters::cells_per_edge, {1, 1000});
    s.advanced("stall_share", &Parameters::stall_share, {0, 0.5});
    sdf::describe_points(s);
  }
};

}  // namespace dismantle::sdf_penalty
