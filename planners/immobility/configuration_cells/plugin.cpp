#include "dismantle/plugin.h"

#include "configuration_cells/configuration_cells.h"

DISMANTLE_PLUGIN("dismantle.configuration_cells", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::ConfigurationCells,
        dismantle::immobility::ConfigurationCellsParameters>(
      "configuration_cells",
      "Two parts of any shape: boxes of their relative poses, none of which that can be reached leads out.",
      {.source = "approximate cell decomposition: Lozano-Perez 1983; proofs of path non-existence: Zhang, Kim and "
                 "Manocha 2008"});
}
