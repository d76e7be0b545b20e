/// Exact signed distance to a solid, used to build the grid and for contact near the surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/poll.h"
#include "dismantle/mesh.h"
#include "dismantle/sdf/candidate_cells.h"
#include "dismantle/sdf/closest_on_triangle.h"
#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/triangle_slabs.h"
#include "dismantle/sdf/wall_sides.h"

namespace dismantle::sdf {

/// Signed distance with its gradient: `value` < 0 inside; `normal` unit, out of the solid.
struct Sample {
  double value = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::uint32_t triangle = geometry::kNoIndex;  ///< closest triangle; geometry::kNoIndex: nothing within the limit
  /// Within this distance of the query point, `value` is linear: its change is normal . displacement, and no convex
  /// edge is near. 0: unknown.
  double flat_radius = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< query point minus closest point
  Feature feature = Feature::face;                   ///< feature of the triangle that contains the closest point
};

/// Requests Sample::flat_radius.
struct FlatnessWanted {
  double within = 0;     ///< for points nearer to the surface than this; 0: none
  double from_edge = 0;  ///< least distance from convex edges
  double least = 0;      ///< smaller radii are reported as 0
};

/// Half-space whose plane passes through a face: near a convex edge or corner, a point is outside the solid if it is
/// outside one of the faces there.
struct FacePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double gap = 0;  ///< signed distance of the point from the plane
};
constexpr int kMaxPlanes = 4;

/// Bounding-volume hierarchy with precomputed triangles, and cached lists of the closest ones where queries were made.
/// The cache does not affect answers; queries allocate only new lists.
class SurfaceQuery {
 public:
  explicit SurfaceQuery(const Solid& solid, const geometry::Poll& poll = {});

  /// Exact signed distance if its magnitude is below `limit`, else a Sample without triangle. `hint`: a triangle that
  /// is probably close (from the last query of a moving point); `list`: from prefetch(). Both only affect speed.
  Sample sample(const Eigen::Vector3d& p, double limit = std::numeric_limits<double>::infinity(),
                std::uint32_t hint = geometry::kNoIndex, const FlatnessWanted& flatness = {},
                const CandidateList* list = nullptr) const;

  /// Lower bound of the distance, from that of the centre of p's cell; 0 near the surface, inside, and far away.
  /// `hint`, `list`: as in sample().
  double lower_bound(const Eigen::Vector3d& p, std::uint32_t hint = geometry::kNoIndex,
                     const CandidateList* list = nullptr) const;

  /// If the point of the surface closest to p lies on a convex edge or corner, or within `near` of a convex edge: the
  /// planes of the faces that meet there, at most kMaxPlanes. Returns how many (0: only the sample's own plane). Flush
  /// parts have hundreds of such contacts, and a single normal would block them in free directions.
  int planes(const Eigen::Vector3d& p, const Sample& sample, double near, FacePlane* out) const;

  /// Finds faces other than the closest that p can run into while it stays in front of one of `fronts`. Appends the
  /// planes of faces that p is in front of and nearly above, up to kMaxPlanes in all, with gaps >= 0. Returns the
  /// distance within which p meets only those faces, and faces that bend from the first of `fronts` by less than 30
  /// degrees; at most `reach`, 0 if unknown. A point behind a face by less than `behind` counts as in front of it.
  double surroundings(const Eigen::Vector3d& p, const FacePlane* fronts, int front_count, double reach, double behind,
                      FacePlane* out, int& count) const;

  /// Signed distance of p from the plane of a triangle. If the closest point lies inside a face, this is bitwise equal
  /// to Sample::value for each triangle of the face.
  double plane_distance(const Eigen::Vector3d& p, std::uint32_t triangle) const {
    const Plane& plane = planes_[face_of_[triangle]];
    return plane.normal.dot(p) - plane.offset;
  }

  /// Prefetches the data that sample() needs at these points, for all points together, since queries are bound by
  /// memory latency. `lists`: receives the list of each point, nullptr if there is none yet.
  void prefetch(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> hints,
                std::span<const CandidateList*> lists) const;
  static constexpr std::size_t kMostPrefetched = 64;  ///< limit of points per call

 private:
  /// Assembly units from the surface within which lists of triangles speed up queries: several margins of a contact,
  /// from where the points come that a step of the simulation may bring near. Answers do not depend on it.
  static constexpr double kNear = 0.2;
  struct Node {
    float lo[3], hi[3];
    std::uint32_t first;  ///< leaf: first slot; inner: right child (left is the next node)
    std::uint32_t count;  ///< 0 = inner
  };
  struct Corner {
    Eigen::Vector3d a, ab, ac;
  };
  /// Plane of a face; coplanar triangles form one face.
  struct Plane {
    Eigen::Vector3d normal;
    double offset = 0;
  };
  void find_faces(const Solid& solid);
  void find_convex_features(const Solid& solid);
  void build(std::uint32_t first, std::uint32_t count, std::vector<std::uint32_t>& ids, const std::vector<Aabb>& boxes,
             const geometry::Poll& poll);
  /// `near_slot`: a triangle that is not far; only affects speed.
  CandidateDraft candidates_of(const Eigen::Vector3d& center, std::uint32_t near_slot) const;
  /// The closest triangle so far.
  struct Nearest {
    double squared;
    std::uint32_t slot = geometry::kNoIndex;
    Closest closest{};
  };
  void update_nearest(const Eigen::Vector3d& p, std::uint32_t slot, Nearest& nearest) const;
  void look_in_list(const Eigen::Vector3d& p, const CandidateList& list, Nearest& nearest) const;
  void search_tree(const Eigen::Vector3d& p, Nearest& nearest) const;
  Sample signed_sample(const Eigen::Vector3d& p, const Nearest& nearest) const;
  Sample wall_sample(const Eigen::Vector3d& p, Sample s, double distance) const;
  double flat_radius(const Eigen::Vector3d& p, const Sample& sample, const CandidateList& list,
                     const FlatnessWanted& wanted) const;

  std::unique_ptr<const WallSides> walls_;  // of an open surface, which the nearest feature does not have two sides of
  double coplanar_ = 0;  // distance from a plane within which a face of a single precision file is flat
  std::unique_ptr<CandidateCells> cells_;
  std::vector<Node> nodes_;
  std::vector<Corner> corners_;          // by slot: leaves are contiguous
  std::vector<TriangleSlabs> slabs_;     // by slot
  double bounded_within_ = 0;            // slabs_ are valid for points nearer to the origin than this
  std::vector<std::uint32_t> triangle_;  // slot -> triangle
  std::vector<std::uint32_t> slot_;      // triangle -> slot
  std::vector<Triangle> indices_;        // by triangle
  std::vector<Plane> planes_;
  std::vector<std::uint32_t> face_of_;  // triangle -> plane
  std::vector<Eigen::Vector3d> face_, vertex_;
  std::vector<std::array<Eigen::Vector3d, 3>> edge_;
  std::vector<std::array<std::uint32_t, 3>> neighbor_;  // across a convex edge; geometry::kNoIndex: flat or concave
  std::vector<std::uint32_t> fan_begin_, fan_;          // per vertex: faces of distinct planes; empty unless convex
};

}  // namespace dismantle::sdf
