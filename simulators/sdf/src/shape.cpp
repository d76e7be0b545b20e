#include "dismantle/sdf/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/geometry/congruence.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::sdf {
namespace {

/// Axes of the smallest box along pairs of the largest face directions or along the mesh's own axes.
Eigen::Quaterniond box_frame(const Mesh& mesh) {
  std::vector<geometry::FaceAxis> directions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d c = geometry::area_vector(mesh, t);
    if (const double area = c.norm(); area > 0)
      geometry::add_face(directions, {c / area, area}, geometry::kSameDirection, 64);
  }
  geometry::sort_by_area(directions, 8);
  const auto volume = [&](const Eigen::Matrix3d& r) {  // of the box in the frame whose axes are r's rows
    Eigen::Vector3d lo = r * mesh.vertices.front(), hi = lo;
    for (const auto& v : mesh.vertices) {
      const Eigen::Vector3d p = r * v;
      lo = lo.cwiseMin(p);
      hi = hi.cwiseMax(p);
    }
    return (hi - lo).cwiseMax(1e-9).prod();
  };
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double best_volume = 0.98 * volume(best);
  for (const auto& first : directions)
    for (const auto& second : directions) {
      Eigen::Vector3d y = second.axis - second.axis.dot(first.axis) * first.axis;
      if (y.norm() < 0.1) continue;
      y.normalize();
      Eigen::Matrix3d r;
      r.row(0) = first.axis;
      r.row(1) = y;
      r.row(2) = first.axis.cross(y);
      const double v = volume(r);
      if (v < 0.999 * best_volume) {
        best_volume = v;
        best = r;
      }
    }
  return Eigen::Quaterniond(best).normalized();
}

Mesh moved(const Mesh& mesh, const Pose& pose) {
  Mesh out = mesh;
  for (auto& v : out.vertices) v = pose * v;
  return out;
}

std::shared_ptr<const Shape> make_shape(const Part& part, const Pose& to_shape, const ShapeOptions& options,
                                        const geometry::Poll& poll) {
  poll();
  auto shape = std::make_shared<Shape>();
  const Mesh mesh = moved(*part.mesh, to_shape);
  shape->box = mesh.box();
  std::vector<Solid> solids;
  if (part.open)
    solids.push_back(walls(mesh, poll));
  else
    solids = split_solids(mesh, poll);
  for (const Solid& solid : solids) {
    poll();
    SolidField field;
    field.box = solid.mesh.box();
    field.surface = std::make_unique<SurfaceQuery>(solid, poll);
    poll();
    // The sign of an open surface does not follow from that of neighbours: all nodes are queried.
    const GridOptions& grid = solid.open ? bounding_grid() : options.grid;
    field.grid = std::make_unique<DistanceGrid>(solid, *field.surface, grid);
    shape->solids.push_back(std::move(field));
  }
  poll();
  if (shape->solids.empty()) throw InputError(part.name, "encloses no volume");
  shape->points = sample_contact_points(mesh, options.points);
  poll();
  shape->hull = hull_corners(mesh.vertices);
  shape->mass = mass_properties(mesh);
  for (const auto& v : mesh.vertices) shape->radius = std::max(shape->radius, (v - shape->mass.center).norm());
  return shape;
}

}  // namespace

std::vector<Placed> build_shapes(const Assembly& assembly, const ShapeOptions& options, RunContext& context) {
  const std::size_t n = assembly.parts.size();
  std::vector<std::size_t> model(n);  // part whose shape is used
  std::vector<Pose> from_model(n);
  std::vector<std::size_t> distinct;
  for (std::size_t i = 0; i < n; ++i) {
    model[i] = i;
    // Coordinates in files have single precision.
    const double same = std::numeric_limits<float>::epsilon() * assembly.parts[i].mesh->box().size().norm();
    for (std::size_t d : distinct)
      if (const auto pose = geometry::congruence(*assembly.parts[d].mesh, *assembly.parts[i].mesh, same)) {
        model[i] = d;
        from_model[i] = *pose;
        break;
      }
    if (model[i] == i) distinct.push_back(i);
  }

  // The thinnest part determines the density of contact points: no part may slip between two of them.
  std::vector<Pose> to_shape(distinct.size());
  double thinnest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < distinct.size(); ++k) {
    const Mesh& mesh = *assembly.parts[distinct[k]].mesh;
    const Eigen::Quaterniond to_box = box_frame(mesh);
    to_shape[k] = {-(to_box * mesh.box().center()), to_box};
    thinnest = std::min(thinnest, moved(mesh, to_shape[k]).box().size().minCoeff());
  }
  ShapeOptions chosen = options;
  chosen.points.spacing = std::clamp(0.5 * thinnest, 0.5 * options.points.spacing, 2 * options.points.spacing);

  const geometry::Poll poll = [&] {
    if (context.should_stop()) throw std::runtime_error("the run was stopped");
  };
  std::vector<Placed> placed(n);
  std::size_t done = 0;
  std::mutex progress;
  parallel_for(
      distinct.size(), context,
      [&](std::size_t k) {
        const Part& part = assembly.parts[distinct[k]];
        placed[distinct[k]] = {make_shape(part, to_shape[k], chosen, poll), to_shape[k].inverse()};
        const std::lock_guard lock(progress);
        context.progress("fields", ++done, distinct.size(), part.name);
      },
      [&] { return context.should_stop(); });
  for (std::size_t i = 0; i < n; ++i)
    if (model[i] != i) placed[i] = {placed[model[i]].shape, from_model[i] * placed[model[i]].rest};
  return placed;
}

}  // namespace dismantle::sdf
