#include "dismantle/geometry/overlap_region.h"

namespace dismantle::geometry {

std::optional<Aabb> overlap_region(const Assembly& assembly, const InitialOverlap& overlap, double max_penetration) {
  const double depth = overlap.allowed();
  if (overlap.declared || !overlap.place || !(depth > 10 * max_penetration)) return std::nullopt;
  if (assembly.parts[overlap.a].open || assembly.parts[overlap.b].open) return std::nullopt;
  Aabb box = overlap.place->region;
  box.inflate(depth + max_penetration);
  return box;
}

}  // namespace dismantle::geometry
