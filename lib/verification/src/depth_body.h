/// What a DepthBody holds.
#pragma once

#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

struct DepthBody::Impl {
  std::vector<geometry::Solid> solids;
};

}  // namespace dismantle
