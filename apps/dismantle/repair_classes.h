/// How parts are fastened and what takes them out, in classes after EN 45554:2020.
#pragma once

#include <string_view>
#include <vector>

#include "dismantle/assembly.h"

namespace dismantle::app {

/// How what a step undoes is fastened, the best first.
enum class FastenerClass {
  none,      ///< nothing is undone: the part is free once others are gone
  reusable,  ///< screws, nuts, circlips: they can be used again
  neither,   ///< it leaves by force only: what it cuts into may not be usable again
};

/// What a step takes, the best first.
enum class ToolClass {
  none,            ///< hands
  basic,           ///< a tool of the standard catalogue fits
  not_determined,  ///< a fastener whose drive or size is not recognised, or that no tool of the catalogue fits
  not_removable,   ///< by force only
};

/// Names in JSON and CSV: "not determined".
std::string_view to_string(FastenerClass c);
std::string_view to_string(ToolClass c);

struct RepairClass {
  FastenerClass fasteners = FastenerClass::none;
  ToolClass tools = ToolClass::none;
  /// Takes the worse of both.
  void add(const RepairClass& other);
};

/// Of a step in which these parts leave. Whether a tool has room is not asked: that is the check `tool_access`.
RepairClass repair_class(const Assembly& assembly, const std::vector<PartId>& leaving, bool forced);

}  // namespace dismantle::app
