#include "part_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_repair.h"

namespace dismantle::ldraw {

namespace {

/// LDraw units. Files state three or four decimals, and primitives meet polygons with rounded corners: nearer than
/// that, corners at open edges are one. Slivers between them would be walls without thickness.
constexpr double kAccuracy = 0.01;

}  // namespace

void add_polygons(const LdrawFile& file, const Placement& placement, bool inverted, Mesh& mesh) {
  const bool mirrored = placement.linear.determinant() < 0;
  for (const Polygon& polygon : file.polygons) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3d& corner : polygon.corners)
      mesh.vertices.push_back(placement.linear * corner + placement.shift);
    const bool turned = polygon.clockwise != (inverted != mirrored);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(turned ? Triangle{base + a, base + c, base + b}
                                      : Triangle{base + a, base + b, base + c});
    };
    if (polygon.corners.size() == 3) {
      add(0, 1, 2);
      continue;
    }
    // The shorter diagonal: the two triangles of a quadrilateral that is not quite flat differ least.
    const auto length = [&](int a, int b) {
      return (polygon.corners[static_cast<std::size_t>(a)] - polygon.corners[static_cast<std::size_t>(b)])
          .squaredNorm();
    };
    if (length(0, 2) <= length(1, 3)) {
      add(0, 1, 2);
      add(0, 2, 3);
    } else {
      add(0, 1, 3);
      add(1, 2, 3);
    }
  }
}

const PartMesh& PartMeshes::of(const std::string& key) {
  const auto known = built_.find(key);
  if (known != built_.end()) return known->second;
  PartMesh part;
  uses_ = 0;
  collect(key, {}, false, part);
  weld(part.mesh, kAccuracy);
  if (part.problem.empty() && part.mesh.triangles.empty()) part.problem = fmt::format("'{}' has no surface", key);
  return built_.emplace(key, std::move(part)).first->second;
}

void PartMeshes::collect(const std::string& key, const Placement& placement, bool inverted, PartMesh& out) {
  if (!out.problem.empty()) return;
  const std::optional<Found> found = library_.find(key);
  if (!found) {
    out.problem = library_.why_missing(key);
    return;
  }
  if (!open_.insert(key).second) {
    out.problem = fmt::format("'{}' refers to itself", key);
    return;
  }
  if (open_.size() > kDeepest || ++uses_ > kMostUses)
    out.problem = fmt::format("it uses more than {} files, or files in files more than {} deep", kMostUses, kDeepest);
  add_polygons(*found->file, placement, inverted, out.mesh);
  for (const Reference& r : found->file->references)
    collect(r.name, placement * r.placement, inverted != r.inverted, out);
  open_.erase(key);
}

std::uint64_t PartMeshes::count(const std::string& key, std::uint64_t limit) {
  if (const auto known = counted_.find(key); known != counted_.end()) return known->second;
  const std::optional<Found> found = library_.find(key);
  if (!found || !open_.insert(key).second) return 0;
  if (open_.size() > kDeepest)
    throw InputError(key, fmt::format("this file is used by files in files, more than {} deep", kDeepest));
  std::uint64_t sum = 0;
  for (const Polygon& polygon : found->file->polygons) sum += polygon.corners.size() - 2;
  for (const Reference& r : found->file->references) sum = std::min(limit, sum + count(r.name, limit));
  open_.erase(key);
  counted_.emplace(key, sum);
  return sum;
}

}  // namespace dismantle::ldraw
