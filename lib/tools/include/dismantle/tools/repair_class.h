/// How parts are fastened and what takes them out, in classes after EN 45554:2020.
#pragma once

#include <string_view>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle::tools {

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
  not_determined,  ///< a fastener whose drive or size is not recognised, or that no tool of the catalogue fits;
                   ///< or several parts leave together
  not_removable,   ///< by force only
};

/// Names in JSON and CSV: "not determined".
DISMANTLE_API std::string_view to_string(FastenerClass c);
DISMANTLE_API std::string_view to_string(ToolClass c);

/// Both classes of a step, or of all steps on the way to a part.
struct DISMANTLE_API RepairClass {
  FastenerClass fasteners = FastenerClass::none;
  ToolClass tools = ToolClass::none;
  /// Takes the worse of both.
  void add(const RepairClass& other);
};

/// Of a step in which these parts leave. Whether a tool has room is not asked: that is the check `tool_access`. Of
/// several parts that leave together, it is not known whether their screws and nuts hold them to the rest: no tool is
/// determined.
DISMANTLE_API RepairClass repair_class(const Assembly& assembly, const std::vector<PartId>& leaving, bool forced);

}  // namespace dismantle::tools
