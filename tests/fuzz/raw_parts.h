/// What every importer promises of the parts that it returns.
#pragma once

#include <vector>

#include "dismantle/importer.h"
#include "expect.h"

namespace dismantle::fuzz {

/// Finite coordinates, triangles of vertices that there are, at least one part.
inline void expect_sound(const std::vector<RawPart>& parts) {
  FUZZ_EXPECT(!parts.empty());
  for (const RawPart& part : parts) {
    if (!part.problem.empty()) continue;
    for (const auto& v : part.mesh.vertices) FUZZ_EXPECT(v.allFinite());
    for (const auto& t : part.mesh.triangles)
      for (const auto corner : t) FUZZ_EXPECT(corner < part.mesh.vertices.size());
  }
}

}  // namespace dismantle::fuzz
