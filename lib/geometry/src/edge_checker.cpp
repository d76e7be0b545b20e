#include "dismantle/geometry/edge_checker.h"

namespace dismantle::geometry {

EdgeChecker::~EdgeChecker() = default;

const EdgeChecker* edge_checker(const PathChecker& checker) { return dynamic_cast<const EdgeChecker*>(&checker); }

}  // namespace dismantle::geometry
