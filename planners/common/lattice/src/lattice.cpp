#include "dismantle/lattice/lattice.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::lattice {
namespace {

using Vec3 = Eigen::Vector3d;

// How far a curved outside may reach over the outermost plane with faces, in cells.
constexpr double kOutside = 1.5;

struct Face {
  Vec3 area;  // outward normal times area
  Vec3 middle;
};

std::vector<Face> faces_of(const std::vector<const Mesh*>& meshes) {
  std::vector<Face> faces;
  for (const Mesh* mesh : meshes)
    for (std::size_t t = 0; t < mesh->triangles.size(); ++t)
      faces.push_back(
          {0.5 * geometry::area_vector(*mesh, t), (mesh->vertex(t, 0) + mesh->vertex(t, 1) + mesh->vertex(t, 2)) / 3});
  return faces;
}

bool is_level(const Face& face, const Vec3& axis) {
  return std::abs(face.area.dot(axis)) > geometry::kSameDirection * face.area.norm();
}

/// Mean of the normals near to `axis`: normals of small triangles lose digits in files.
Vec3 refined(const std::vector<Face>& faces, const Vec3& axis) {
  Vec3 sum = Vec3::Zero();
  for (const Face& f : faces)
    if (is_level(f, axis)) sum += f.area.dot(axis) < 0 ? Vec3(-f.area) : f.area;
  return sum.normalized();
}

/// Three orthogonal axes with the most flat faces; none if there are not three with faces.
std::optional<Eigen::Matrix3d> axes_of(const std::vector<Face>& faces) {
  std::vector<geometry::FaceAxis> normals;
  for (const Face& f : faces)
    if (const double area = f.area.norm(); area > 0) normals.push_back({f.area / area, area});
  std::vector<geometry::FaceAxis> found = geometry::rounded_axes(normals);
  geometry::sort_by_area(found, 32);
  if (found.empty()) return std::nullopt;
  Eigen::Matrix3d rows;
  rows.row(0) = refined(faces, found[0].axis);
  const auto across = std::find_if(found.begin(), found.end(), [&](const geometry::FaceAxis& f) {
    return std::abs(f.axis.dot(found[0].axis)) < 0.01;
  });
  if (across == found.end()) return std::nullopt;
  rows.row(1) = refined(faces, across->axis);
  rows.row(2) = Vec3(rows.row(0)).cross(Vec3(rows.row(1))).normalized();
  // The nearest orthogonal axes.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rows, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if ((nearest - rows).cwiseAbs().maxCoeff() > 1e-3) return std::nullopt;
  return nearest;
}

/// Flat faces with one normal.
struct Planes {
  std::vector<std::pair<double, double>> at;  // offset, area; by descending area
  double area = 0;
};

Planes planes_of(const std::vector<Face>& faces, const Vec3& normal, double same) {
  std::vector<std::pair<double, double>> all;
  for (const Face& f : faces)
    if (is_level(f, normal) && f.area.dot(normal) > 0) all.emplace_back(f.middle.dot(normal), f.area.norm());
  std::sort(all.begin(), all.end());
  Planes planes;
  for (const auto& [offset, area] : all) {
    planes.area += area;
    if (!planes.at.empty() && offset - planes.at.back().first < same)
      planes.at.back().second += area;
    else
      planes.at.emplace_back(offset, area);
  }
  std::stable_sort(planes.at.begin(), planes.at.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return planes;
}

double fitting(const Planes& planes, double base, double pitch, double same) {
  double area = 0;
  for (const auto& [offset, weight] : planes.at) {
    const double steps = (offset - base) / pitch;
    if (std::abs(steps - std::round(steps)) * pitch < same) area += weight;
  }
  return area;
}

/// The plane through whose grid the most area fits.
std::pair<double, double> best_base(const Planes& planes, double pitch, double same) {
  std::pair<double, double> best{0, -1};  // offset, area
  for (std::size_t k = 0; k < std::min<std::size_t>(planes.at.size(), 6); ++k)
    if (const double area = fitting(planes, planes.at[k].first, pitch, same); area > best.second)
      best = {planes.at[k].first, area};
  return best;
}

/// Do most planes of the grid have faces? Few planes fit some fine grid by chance. A curved outside has none, so planes
/// are expected up to kOutside cells from both ends.
bool has_faces(const Planes& up, const Planes& down, double base, double pitch, double lo, double hi, double same) {
  std::set<long> used;
  for (const Planes* planes : {&up, &down})
    for (const auto& [offset, area] : planes->at) {
      const double steps = (offset - base) / pitch, whole = std::round(steps);
      if (std::abs(steps - whole) * pitch < same) used.insert(std::lround(whole));
    }
  if (used.empty()) return false;
  const long first = *used.begin(), last = *used.rbegin();
  return 2 * static_cast<long>(used.size()) > last - first + 1 &&
         static_cast<double>(first) - (lo - base) / pitch < kOutside &&
         (hi - base) / pitch - static_cast<double>(last) < kOutside;
}

struct Grid {
  double pitch = 0, origin = 0, play = 0, area = 0, reach = 0;
};

/// The coarsest grid along an axis that nearly as much area fits as any.
std::optional<Grid> grid_along(const std::vector<Face>& faces, const Vec3& axis, double lo, double hi,
                               double tolerance) {
  const double extent = hi - lo;
  const double same = 0.3 * tolerance;
  // Offsets of both along the axis. Faces of one side have one phase, and the other differs from it by the play.
  const Planes up = planes_of(faces, axis, same);
  const Planes down = [&] {
    Planes planes = planes_of(faces, -axis, same);
    for (auto& plane : planes.at) plane.first = -plane.first;
    return planes;
  }();
  if (up.at.empty() || down.at.empty()) return std::nullopt;
  std::vector<Grid> grids;
  const auto consider = [&](double pitch, double reach) {
    if (!(extent / pitch <= kMostCells)) return;
    const auto [top, top_area] = best_base(up, pitch, same);
    const auto [bottom, bottom_area] = best_base(down, pitch, same);
    const double steps = std::round((bottom - top) / pitch), play = 0.5 * (bottom - top - steps * pitch);
    if (play < -tolerance || play > pitch / 8) return;
    grids.push_back({pitch, top + play, play, top_area + bottom_area, reach});
  };
  for (const Planes* planes : {&up, &down}) {
    const std::size_t count = std::min<std::size_t>(planes->at.size(), 10);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        const double reach = std::abs(planes->at[a].first - planes->at[b].first);
        for (int k = 1; k <= 16; ++k) consider(reach / k, reach);
      }
  }
  // One cell thick along this axis.
  for (const auto& [offset, area] : up.at)
    if (up.at.size() == 1 && down.at.size() == 1) consider(std::abs(offset - down.at[0].first), extent);
  double most = 0;
  for (const Grid& g : grids) most = std::max(most, g.area);
  if (most < 0.6 * (up.area + down.area)) return std::nullopt;
  std::erase_if(grids, [&](const Grid& g) { return g.area < 0.97 * most; });
  double coarsest = 0;
  for (const Grid& g : grids) coarsest = std::max(coarsest, g.pitch);
  // Planes that are far apart give the most digits.
  std::erase_if(grids, [&](const Grid& g) { return g.pitch < coarsest - 2 * same; });
  Grid best =
      *std::max_element(grids.begin(), grids.end(), [](const Grid& a, const Grid& b) { return a.reach < b.reach; });
  // A small face between two planes of this grid counts, too: the pitch is divided if most of the rest then fits.
  for (int k = 2; k <= 16; ++k) {
    const double rest = up.area + down.area - best.area;
    grids.clear();
    consider(best.pitch / k, best.reach);
    if (grids.empty() || grids.front().area - best.area <= 0.5 * rest + 1e-9 * (up.area + down.area)) continue;
    best = grids.front();
    break;
  }
  best.origin += std::floor((lo - best.origin) / best.pitch + 0.25) * best.pitch;  // cell 0 is at the lower end
  if (!has_faces(up, down, best.origin, best.pitch, lo, hi, best.play + same)) return std::nullopt;
  return best;
}

}  // namespace

std::optional<Lattice> lattice_of(const std::vector<const Mesh*>& meshes, double tolerance) {
  const std::vector<Face> faces = faces_of(meshes);
  const auto axes = axes_of(faces);
  if (!axes) return std::nullopt;
  double level = 0, total = 0;
  for (const Face& f : faces) {
    total += f.area.norm();
    for (int k = 0; k < 3; ++k)
      if (is_level(f, axes->row(k))) level += f.area.norm();
  }
  if (level < total / 3) return std::nullopt;
  Lattice lattice;
  lattice.axes = *axes;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes->row(k);
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const Mesh* mesh : meshes)
      for (const Vec3& v : mesh->vertices) {
        lo = std::min(lo, axis.dot(v));
        hi = std::max(hi, axis.dot(v));
      }
    const auto grid = grid_along(faces, axis, lo, hi, tolerance);
    if (!grid) return std::nullopt;
    lattice.pitch[k] = grid->pitch;
    lattice.origin[k] = grid->origin;
  }
  return lattice;
}

}  // namespace dismantle::lattice
