#include "dismantle/geometry/congruent_parts.h"

#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "dismantle/geometry/congruence.h"

namespace dismantle::geometry {
namespace {

template <class Tolerance>
std::vector<ShapePlacement> congruent_within(const std::vector<Part>& parts, const Tolerance& tolerance) {
  std::vector<ShapePlacement> out;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>>
      originals;  // by number of vertices, triangles
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Mesh& mesh = *parts[i].mesh;
    ShapePlacement placement{i, {}};
    auto& known = originals[{mesh.vertices.size(), mesh.triangles.size()}];
    for (const std::size_t original : known) {
      if (const auto pose = congruence(*parts[original].mesh, mesh, tolerance(mesh))) {
        placement = {original, *pose};
        break;
      }
    }
    if (placement.original == i) known.push_back(i);
    out.push_back(placement);
  }
  return out;
}

/// Largest distance between the places of a corner of the box under the two poses.
double apart(const Aabb& box, const Pose& a, const Pose& b) {
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = (corner >> k & 1) != 0 ? box.hi[k] : box.lo[k];
    most = std::max(most, (a * x - b * x).norm());
  }
  return most;
}

}  // namespace

std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts) {
  // Files round coordinates to six digits, of positions that may be a hundred times the part's size.
  return congruent_within(parts, [](const Mesh& mesh) { return 1e-4 * mesh.box().size().norm(); });
}

std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts, double tolerance) {
  return congruent_within(parts, [tolerance](const Mesh&) { return tolerance; });
}

std::vector<PairPlacement> find_alike(const std::vector<Part>& parts,
                                      const std::vector<std::pair<PartId, PartId>>& pairs, double tolerance) {
  const std::vector<ShapePlacement> shape = find_congruent(parts, tolerance);
  std::vector<PairPlacement> out;
  // By both shapes and the place of the second relative to the first, rounded: the scan of equal keys stays short.
  std::map<std::tuple<std::size_t, std::size_t, std::array<long, 3>>, std::vector<std::size_t>> originals;
  const auto relative = [&](std::size_t pair) {
    return shape[pairs[pair].first].pose.inverse() * shape[pairs[pair].second].pose;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ShapePlacement &a = shape[pairs[i].first], &b = shape[pairs[i].second];
    const Pose lies = relative(i);
    const Eigen::Vector3d rounded = lies.t / (100 * tolerance);
    auto& known = originals[{
        a.original, b.original, {std::lround(rounded.x()), std::lround(rounded.y()), std::lround(rounded.z())}}];
    PairPlacement placement{i, {}};
    for (const std::size_t k : known) {
      if (!(apart(parts[b.original].mesh->box(), lies, relative(k)) <= tolerance)) continue;
      placement = {k, a.pose * shape[pairs[k].first].pose.inverse()};
      break;
    }
    if (placement.original == i) known.push_back(i);
    out.push_back(placement);
  }
  return out;
}

}  // namespace dismantle::geometry
