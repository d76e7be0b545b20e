#include "dismantle/plugin.h"

#include "translations/translations.h"

DISMANTLE_PLUGIN("dismantle.translations", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::Translations,
        dismantle::immobility::TranslationsParameters>(
      "translations", "Parts on a common grid, as of interlocking puzzles: no translations take them apart.",
      {.source = "all arrangements on the grid"});
}
