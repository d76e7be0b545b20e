/// The bounding box of parts where they are placed.
#pragma once

#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::path {

/// World axes, assembly units; empty without parts.
inline Aabb box_of(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  Aabb box;
  for (const auto& p : parts)
    for (const auto& v : assembly.parts[p.part].mesh->vertices) box.extend(p.pose * v);
  return box;
}

}  // namespace dismantle::path
