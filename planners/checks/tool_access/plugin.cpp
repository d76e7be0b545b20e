#include "dismantle/plugin.h"

#include "tool_access.h"

DISMANTLE_PLUGIN("dismantle.tool_access", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::ToolAccess, dismantle::checks::ToolAccessParameters>(
      "tool_access", "Counts fasteners that no tool reaches, and changes of the tool.",
      {.source = "use volumes: Wilson, Geometric reasoning about assembly tools, 1998"});
}
