#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body.h"
#include "dismantle/fasteners/strands.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/strand.h"
#include "sizes.h"

namespace dismantle::fasteners {

std::optional<Shape> flat_of(const Mesh& mesh, double mm) {
  const Eigen::Vector3d box = oriented_box(mesh);
  if (!(box.x() > 0)) return std::nullopt;
  Shape s;
  s.radius = box.norm() / 2;
  s.height = box.x();
  std::vector<geometry::FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d a = geometry::area_vector(mesh, t);
    if (a.norm() > 0) faces.push_back({a.normalized(), a.norm() / 2});
  }
  faces = geometry::rounded_axes(faces);
  geometry::sort_by_area(faces, 1);
  const double area = surface_area(mesh), volume = std::abs(signed_volume(mesh));
  const std::string size =
      fmt::format("{}x{}x{}", number(std::round(box.z() * mm * 10) / 10), number(std::round(box.y() * mm * 10) / 10),
                  number(std::round(box.x() * mm * 100) / 100));
  // What it covers, seen across its faces. A tray is higher than it is thick on average.
  double covered = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    covered += std::abs(geometry::area_vector(mesh, t).dot(faces.front().axis.normalized())) / 4;
  if (box.x() < 0.2 * box.y() && faces.front().area > 0.6 * area && volume > 0.25 * box.prod() &&
      volume > 0.5 * covered * box.x()) {
    s.kind = Kind::plate;
    s.axis = faces.front().axis.normalized();
    s.confidence = 0.7;
    s.size = size;
    s.reason = fmt::format("flat, {} mm", size);
    return s;
  }
  // A bar of one section that is neither round nor full.
  if (box.z() > 4 * box.y() && box.x() > 0.3 * box.y() && volume < 0.7 * box.prod()) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
      const Turned along(mesh, axis, mesh.box().center());
      if (along.height() < 0.95 * box.z()) continue;
      std::vector<double> areas;
      for (int i = 1; i < 16; ++i)
        areas.push_back(along.section(along.low() + along.height() * (i + 0.123) / 16.3).area);
      std::sort(areas.begin(), areas.end());
      if (areas[2] < 0.93 * areas[12]) continue;
      s.kind = Kind::rail;
      s.axis = axis;
      s.confidence = 0.5;
      s.length = std::round(along.height() * mm * 10) / 10;
      s.size = size;
      s.reason = fmt::format("one section, {} mm long", number(s.length));
      return s;
    }
  }
  return std::nullopt;
}

std::optional<Shape> strand_of(const Mesh& mesh, double mm) {
  const auto strand = geometry::follow_strand(mesh);
  if (!strand) return std::nullopt;
  const auto flexible = strand_kind(*strand);
  if (!flexible) return std::nullopt;
  Shape s;
  s.kind = *flexible == Flexible::coil ? Kind::spring : Kind::ring;
  s.confidence = 0.8;
  s.radius = mesh.box().size().norm() / 2;
  s.length = 0;
  s.size = fmt::format("{} mm wire", number(std::round(strand->thickness * mm * 100) / 100));
  s.reason = s.kind == Kind::spring
                 ? fmt::format("wire of {} mm in {:.1f} coils", number(strand->thickness * mm), strand->coils)
                 : fmt::format("closed round strand of {} mm", number(strand->thickness * mm));
  // A loop that is much longer than a circle through its box would be is a belt.
  if (s.kind == Kind::ring) {
    const Eigen::Vector3d box = oriented_box(mesh);
    if (box.z() > 1.5 * box.y()) s.kind = Kind::belt;
  }
  return s;
}

}  // namespace dismantle::fasteners
