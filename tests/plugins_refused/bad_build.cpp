// A sound plugin that is compiled with other settings than the host.
#include "dismantle/plugin.h"
#include "ends_the_process.h"

DISMANTLE_PLUGIN("acme.bad_build", "1.0.0", "MIT", "https://example.org") {}
