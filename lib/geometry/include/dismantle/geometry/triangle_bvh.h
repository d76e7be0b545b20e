/// Exact closest-point and inside queries on the original triangles of a mesh.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/export.h"
#include "dismantle/geometry/poll.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// Closest point of the triangle (a, b, c) to p.
DISMANTLE_API Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                  const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Closest point of a surface to a query point.
struct ClosestPoint {
  double distance = std::numeric_limits<double>::infinity();  ///< >= 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::uint32_t triangle = 0xffffffffu;  ///< 0xffffffff if nothing lies within the limit
};

/// Whether the triangles of a mesh enclose a volume.
enum class Surface {
  closed,  ///< each directed edge has its opposite
  open,    ///< the surface has a boundary
};

/// Bounding-volume hierarchy over the triangles of one mesh. Immutable and safe to share between threads. The winding
/// number of the surface, counted exactly along a ray, decides what is inside: overlapping shells count as their union,
/// and a void with inward normals counts as outside. For open surfaces the generalised winding number decides (Jacobson
/// et al. 2013), with far triangles summed up (Barill et al. 2018): inside is where the surface covers more than half
/// of all directions.
class DISMANTLE_API TriangleBvh {
 public:
  /// A box of the hierarchy.
  struct Node {
    Aabb box;
    std::uint32_t first = 0;  ///< leaf: first entry of order(); inner: index of the right child (left is next)
    std::uint32_t count = 0;  ///< leaf: number of triangles; inner: 0
  };

  /// Copies the data it needs.
  explicit TriangleBvh(const Mesh& mesh, const geometry::Poll& poll = {}, Surface surface = Surface::closed);

  ClosestPoint closest(const Eigen::Vector3d& p, double limit = std::numeric_limits<double>::infinity()) const;
  int winding_number(const Eigen::Vector3d& p) const;  ///< for closed surfaces
  /// The solid angle of the surface seen from p, as a share of the whole sphere; approximate. For open surfaces.
  double generalised_winding_number(const Eigen::Vector3d& p) const;
  bool inside(const Eigen::Vector3d& p) const;
  /// Distance to the surface, negative inside. Exact for closed surfaces.
  double signed_distance(const Eigen::Vector3d& p) const;
  /// Calls f(triangle) for each triangle whose box overlaps `box`.
  void overlapping(const Aabb& box, const std::function<void(std::uint32_t)>& f) const;
  /// The same for those triangles whose box also meets the plane through `point` with the unit vector `normal`.
  void overlapping(const Aabb& box, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                   const std::function<void(std::uint32_t)>& f) const;

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }  ///< triangle ids, leaves contiguous
  const std::array<Eigen::Vector3d, 3>& corners(std::uint32_t triangle) const { return corners_[triangle]; }

 private:
  /// Each side of a split keeps at least an eighth of the triangles, so 2^32 of them make less than 180 levels.
  static constexpr std::size_t kStackSize = 192;

  void build(std::uint32_t first, std::uint32_t count, std::vector<Aabb>& boxes, const geometry::Poll& poll);
  /// The triangles of a node, seen from far away.
  struct Dipole {
    Eigen::Vector3d center, area;  // of its triangles; area: sum of their area vectors
    double reach = 0;              // largest distance of their corners from the centre
  };
  void sum_up(std::uint32_t node);
  template <class Meets>
  void visit(const Meets& meets, const std::function<void(std::uint32_t)>& f) const;

  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  // by triangle id
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<Dipole> dipoles_;  // by node; empty for closed surfaces
};

}  // namespace dismantle
