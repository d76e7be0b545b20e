#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "solids.h"

namespace dismantle::samples {

double volume(const Mesh& mesh) {
  double six = 0;
  if (mesh.vertices.empty()) return 0;
  const Point origin = mesh.vertices.front();
  for (const Triangle& t : mesh.triangles)
    six += (mesh.vertices[t[0]] - origin).dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  return six / 6;
}

void require_solid(const Mesh& mesh, const std::string& name) {
  const auto fail = [&name](const char* what) { throw std::logic_error("sample part " + name + ": " + what); };
  if (mesh.empty()) fail("no triangles");
  std::vector<std::uint64_t> edges, opposite;
  for (const Triangle& t : mesh.triangles) {
    const Point u = mesh.vertices[t[1]] - mesh.vertices[t[0]], v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
    if (!(u.cross(v).norm() > 1e-7 * longest * longest)) fail("degenerate triangle");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back(a << 32 | b);
      opposite.push_back(b << 32 | a);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(opposite.begin(), opposite.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) fail("an edge is used twice");
  if (edges != opposite) fail("not closed");
  if (!(volume(mesh) > 0)) fail("inside out");
}

}  // namespace dismantle::samples
