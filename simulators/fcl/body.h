/// Data of a part for the fcl simulator, computed once per distinct shape.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "collision_mesh.h"
#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/surface_query.h"

namespace dismantle::mesh_collision {

struct EdgeGraph {
  std::vector<std::array<std::uint32_t, 2>> edges;        ///< vertices, the lower first
  std::vector<std::array<std::uint32_t, 3>> of_triangle;  ///< edge k joins corners k and k + 1
  std::vector<std::uint32_t> vertex_begin, vertex_edges;  ///< edges at each vertex; one entry more than vertices
  std::vector<std::uint32_t> shell_vertex;                ///< one vertex of each connected shell
};
EdgeGraph edge_graph(const Mesh& mesh);

/// One outer shell with its voids.
struct SolidPart {
  Mesh mesh;
  Aabb box;
  std::unique_ptr<const sdf::SurfaceQuery> surface;
};

/// A copy of a surface, displaced inwards as far as possible with every point at most `depth` from the original.
struct Inset {
  double depth = 0;
  CollisionMesh surface;
  std::vector<Eigen::Vector3d> shell_points;  ///< one point of each connected shell
};

/// In the assembled frame of the first part with this shape.
struct Body {
  Mesh mesh;  ///< flat faces merged (flat_faces.h) if that saves enough
  Aabb box;
  std::vector<SolidPart> solids;
  EdgeGraph graph;
  CollisionMesh surface;
  std::vector<Eigen::Vector3d> hull;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of mass
  double radius = 0;                                 ///< largest distance of a vertex from `center`
  std::map<double, Inset> insets;                    ///< by depth, assembly units
};

/// A shape and its assembled pose: `rest` maps the shape frame to the assembled frame.
struct PlacedBody {
  std::shared_ptr<const Body> body;
  Pose rest;
};

/// `depths`: of the insets to build. @throws InputError (naming `part`) if the part encloses no volume.
std::shared_ptr<const Body> make_body(const Part& part, const std::vector<double>& depths);

/// Displacement of each vertex into the mesh, at most `depth` long: into all faces around it, and at most a quarter of
/// the material in that direction. Zero if no direction leads into all faces.
std::vector<Eigen::Vector3d> inset_displacements(const Mesh& mesh, const std::vector<SolidPart>& solids, double depth);

/// Signed distance to the union of the solids, clamped at `limit` (shape frame, < 0 inside).
double signed_distance(const std::vector<SolidPart>& solids, const Eigen::Vector3d& p,
                       double limit = std::numeric_limits<double>::infinity());

}  // namespace dismantle::mesh_collision
