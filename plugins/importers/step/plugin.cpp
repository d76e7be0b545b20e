#include "dismantle/plugin.h"

#include "step_importer.h"

DISMANTLE_PLUGIN("dismantle.step", "0.1.0", "MIT", "https://github.com/dismantle") {
  r.add<dismantle::Importer, dismantle::step_import::StepImporter, dismantle::step_import::StepParameters>(
      "step", "STEP files through Open CASCADE in a process of its own: products, instances, units, colours.",
      {.source = "ISO 10303-21, -203, -214, -242"});
}
