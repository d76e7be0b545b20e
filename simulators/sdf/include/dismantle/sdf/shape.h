/// Contact data of a part, computed once per distinct shape.
#pragma once

#include <memory>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/geometry/mass_properties.h"
#include "dismantle/run_context.h"
#include "dismantle/sdf/contact_points.h"
#include "dismantle/sdf/distance_grid.h"
#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/surface_query.h"

namespace dismantle::sdf {

struct SolidField {
  Aabb box;
  std::unique_ptr<const SurfaceQuery> surface;
  std::unique_ptr<const DistanceGrid> grid;
};

/// In its own frame, with axes along its largest faces: fields are smallest there, and results do not depend on the
/// orientation of the assembly.
struct Shape {
  Aabb box;
  std::vector<SolidField> solids;
  ContactPoints points;
  std::vector<Eigen::Vector3d> hull;  ///< corners of the convex hull
  MassProperties mass;
  double radius = 0;  ///< largest distance of a vertex from mass.center
};

/// A shape in assembled position.
struct Placed {
  std::shared_ptr<const Shape> shape;
  Pose rest;  ///< shape frame -> assembled frame
};

struct ShapeOptions {
  GridOptions grid = bounding_grid();  ///< sufficient for DistanceModel::exact
  ContactPointOptions points;
  // Shares of the verifier's tolerance, see PreparedShapes.
  double facet_share = 0.3;
  double contact_depth = 0.02;
};

/// One entry per part, in part order. Parts with the same triangles up to a rigid motion share one Shape.
/// Shapes are built on context.threads threads; the result does not depend on their number.
std::vector<Placed> build_shapes(const Assembly& assembly, const ShapeOptions& options, RunContext& context);

}  // namespace dismantle::sdf
