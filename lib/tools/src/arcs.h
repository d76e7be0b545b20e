// Unions of ranges of angles.
#pragma once

#include <algorithm>
#include <numbers>

#include "dismantle/tools/access.h"

namespace dismantle::tools {

inline constexpr double kTurn = 2 * std::numbers::pi;

/// Ascending, without overlap.
inline Arcs joined(Arcs arcs) {
  std::sort(arcs.begin(), arcs.end());
  Arcs out;
  for (const auto& arc : arcs) {
    if (!out.empty() && arc.first <= out.back().second)
      out.back().second = std::max(out.back().second, arc.second);
    else
      out.push_back(arc);
  }
  return out;
}

}  // namespace dismantle::tools
