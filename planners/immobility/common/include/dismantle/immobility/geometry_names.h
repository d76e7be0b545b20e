/// Names of lib/geometry without their namespace.
#pragma once

namespace dismantle::geometry {}
namespace dismantle::immobility {
using namespace geometry;
}
