#include "dismantle/geometry/congruent_parts.h"

#include <map>
#include <utility>

#include "dismantle/geometry/congruence.h"

namespace dismantle::geometry {

std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts) {
  std::vector<ShapePlacement> out;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>>
      originals;  // by number of vertices, triangles
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Mesh& mesh = *parts[i].mesh;
    ShapePlacement placement{i, {}};
    auto& known = originals[{mesh.vertices.size(), mesh.triangles.size()}];
    for (const std::size_t original : known) {
      const Mesh& other = *parts[original].mesh;
      // Files round coordinates to six digits, of positions that may be a hundred times the part's size.
      const double rounding = 1e-4 * mesh.box().size().norm();
      if (const auto pose = congruence(other, mesh, rounding)) {
        placement = {original, *pose};
        break;
      }
    }
    if (placement.original == i) known.push_back(i);
    out.push_back(placement);
  }
  return out;
}

}  // namespace dismantle::geometry
