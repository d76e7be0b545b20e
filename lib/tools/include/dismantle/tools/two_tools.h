/// Two tools at once: one turns a screw or nut, the other holds what must not turn with it.
#pragma once

#include <optional>
#include <span>

#include "dismantle/export.h"
#include "dismantle/tools/access.h"

namespace dismantle::tools {

/// A tool on its fastener, with the angles that each obstacle blocks.
struct ToolOn {
  const Use& use;
  const Fastener& fastener;
  std::span<const Arcs* const> blocked;
};

/// Where both have room.
struct BothAccess {
  Access turning, holding;
};

/// Places for two tools that do not meet each other, their hands included: one swings and follows the travel of its
/// fastener, the other stands still. `holding` has a fastener without travel; the axes are parallel. What is found is
/// proved; between places 10 degrees apart a narrow one may be missed.
DISMANTLE_API std::optional<BothAccess> room_for_both(const ToolOn& turning, const ToolOn& holding, bool hand);

}  // namespace dismantle::tools
