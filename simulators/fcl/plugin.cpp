#include "dismantle/plugin.h"

#include "simulator.h"

DISMANTLE_PLUGIN("dismantle.fcl", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::Simulator, dismantle::mesh_collision::FclSimulator, dismantle::mesh_collision::Parameters>(
      "fcl", "Geometry only: collisions of meshes by FCL, depth by distance. No dynamics.",
      {.source = "Pan, Chitta and Manocha 2012 (FCL)", .provides = dismantle::mesh_collision::provided()});
}
