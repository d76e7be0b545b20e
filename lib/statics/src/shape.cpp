#include "shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/mesh_edges.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kBent = 0.98;  // cosine of the angle at which an edge is one: 11 degrees

void measure(Shape::Data& d) {
  const Vec3 origin = d.mesh.box().center();
  Vec3 moment = Vec3::Zero();
  for (std::size_t t = 0; t < d.mesh.triangles.size(); ++t) {
    const Vec3 a = d.mesh.vertex(t, 0) - origin, b = d.mesh.vertex(t, 1) - origin, c = d.mesh.vertex(t, 2) - origin;
    const double v = a.dot(b.cross(c)) / 6;
    d.volume += v;
    moment += v * (a + b + c) / 4;
    const Vec3 area = (b - a).cross(c - a);
    d.normals.push_back(area.norm() > 0 ? Vec3(area.normalized()) : Vec3(Vec3::Zero()));
  }
  d.center = origin;
  if (d.volume > 0) d.center += moment / d.volume;
  for (const Vec3& v : d.mesh.vertices) d.radius = std::max(d.radius, (v - d.center).norm());
}

void find_ridges(Shape::Data& d) {
  std::vector<std::vector<Vec3>> directions(d.mesh.vertices.size());
  const auto edges = mesh_detail::sorted_edges(d.mesh);
  mesh_detail::for_each_edge(edges, [&](const mesh_detail::EdgeRef* first, const mesh_detail::EdgeRef* last) {
    if (last - first != 2) return;
    const Vec3 &a = d.mesh.vertices[first->lo], &b = d.mesh.vertices[first->hi];
    const Vec3 left = d.normals[first->triangle], right = d.normals[first[1].triangle];
    const double length = (b - a).norm();
    if (length == 0 || left.isZero() || right.isZero() || left.dot(right) > kBent) return;
    directions[first->lo].push_back((b - a) / length);
    directions[first->hi].push_back((a - b) / length);
    // Outward bend: the next face lies below the plane of this one.
    const Vec3 along = first->forward ? Vec3(b - a) : Vec3(a - b);
    if (left.cross(right).dot(along) > 0) d.ridges.push_back({a, b, left, right});
  });
  for (std::size_t v = 0; v < directions.size(); ++v)
    if (directions[v].size() >= 3) d.tips.push_back({d.mesh.vertices[v], std::move(directions[v])});
}

}  // namespace

Shape::Shape(const Mesh& mesh) : data_(std::make_unique<Data>(mesh)) {
  measure(*data_);
  find_ridges(*data_);
}
Shape::~Shape() = default;
Shape::Shape(Shape&&) noexcept = default;

double Shape::volume() const { return data_->volume; }
Vec3 Shape::center() const { return data_->center; }
double Shape::radius() const { return data_->radius; }
const Mesh& Shape::mesh() const { return data_->mesh; }

double lowest(const PlacedShape& part, const Vec3& up) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& v : part.shape->mesh().vertices) least = std::min(least, up.dot(part.pose * v));
  return least;
}

}  // namespace dismantle::statics
