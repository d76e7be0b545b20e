#include "dismantle/push_search/touching_surfaces.h"

#include "dismantle/search/placed_parts.h"

namespace dismantle::push {
std::vector<geometry::SurfaceSample> touching_surfaces(const std::vector<Contact>& contacts,
                                                       const std::vector<PlacedPart>& moving) {
  std::vector<geometry::SurfaceSample> samples;
  for (const Contact& c : contacts) {
    if (c.on_edge) continue;
    if (path::contains(moving, c.other)) continue;
    samples.push_back({c.point, c.normal});
  }
  return samples;
}

}  // namespace dismantle::push
