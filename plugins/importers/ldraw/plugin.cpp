#include "dismantle/plugin.h"

#include "ldraw_importer.h"

DISMANTLE_PLUGIN("dismantle.ldraw", "0.1.0", "MIT", "https://github.com/dismantle") {
  r.add<dismantle::Importer, dismantle::ldraw::LdrawImporter, dismantle::ldraw::LdrawParameters>(
      "ldraw", "LDraw models (.mpd, .ldr) with their parts library: parts, sub-models, building steps.",
      {.source = "LDraw file format specification 1.0.2"});
}
