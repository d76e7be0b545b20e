/// Exact signed distance to a solid: what the grid is built from, and what contact uses near the surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/sdf/candidate_cells.h"
#include "dismantle/sdf/closest_on_triangle.h"
#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/triangle_slabs.h"

namespace dismantle::sdf {

/// Signed distance with its gradient: `value` < 0 inside; `normal` unit, out of the solid.
struct Sample {
  double value = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::uint32_t triangle = geometry::kNoIndex;  ///< closest triangle; geometry::kNoIndex: nothing within the limit
  /// Within this distance of the point asked for, `value` is linear: its change is normal . displacement, and no convex
  /// edge is near. 0 where that is not known.
  double flat_radius = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< the point asked for minus the closest one
  Feature feature = Feature::face;                   ///< of the triangle, that the closest point lies on
};

/// Asks for Sample::flat_radius.
struct FlatnessWanted {
  double within = 0;     ///< of points nearer to the surface than this; 0: of none
  double from_edge = 0;  ///< convex edges have to stay so far away
  double least = 0;      ///< smaller radii are not worth looking for
};

/// Half-space whose plane passes through a face: a point is outside the solid near a convex edge or corner
/// as soon as it is outside one of the faces there.
struct FacePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double gap = 0;  ///< signed distance of the point from the plane
};
constexpr int kMaxPlanes = 4;

/// Bounding-volume hierarchy with precomputed triangles, and lists of the closest ones where contact has been. Answers
/// never change; queries allocate nothing but a list where none has been asked for yet.
class SurfaceQuery {
 public:
  /// `near`: distance from the surface up to which lists of triangles make queries fast; > 0. Answers do not depend on
  /// it.
  explicit SurfaceQuery(const Solid& solid, double near = 0.1, const geometry::Poll& poll = {});

  /// Exact signed distance if its magnitude is below `limit`, else a Sample without triangle.
  /// `hint`: a triangle that is probably close (from the last query of a moving point); `list`: as prefetch() found it.
  /// Both only affect speed.
  Sample sample(const Eigen::Vector3d& p, double limit = std::numeric_limits<double>::infinity(),
                std::uint32_t hint = geometry::kNoIndex, const FlatnessWanted& flatness = {},
                const CandidateList* list = nullptr) const;

  /// A distance that the true one is not below, from that of the middle of p's cell; 0 near the surface, inside, and
  /// far away. `hint`, `list`: as in sample().
  double lower_bound(const Eigen::Vector3d& p, std::uint32_t hint = geometry::kNoIndex,
                     const CandidateList* list = nullptr) const;

  /// If the point of the surface closest to p lies on a convex edge or corner, or within `near` of a convex
  /// edge: the planes of the faces that meet there, at most kMaxPlanes. Returns how many (0: none, the
  /// sample's own plane is all there is). Parts that stand flush make such contacts by the hundred, and a
  /// single normal would hold them in directions that are free.
  int planes(const Eigen::Vector3d& p, const Sample& sample, double near, FacePlane* out) const;

  /// What p can run into, besides what it is closest to, while it stays in front of one of `fronts`. Appends the planes
  /// of faces that p is in front of and near the middle of, up to kMaxPlanes in all, with gaps >= 0. Returns a
  /// distance: moved by less, p meets no face but those, and such as bend from the first of `fronts` by less than 30
  /// degrees. At most `reach`; 0 where it is not known. A point that is behind a face by less than `behind` counts as
  /// in front of it.
  double surroundings(const Eigen::Vector3d& p, const FacePlane* fronts, int front_count, double reach, double behind,
                      FacePlane* out, int& count) const;

  /// Signed distance of p from the plane of a triangle. Where the closest point lies inside a face this is `value`, bit
  /// by bit, for each triangle of that face.
  double plane_distance(const Eigen::Vector3d& p, std::uint32_t triangle) const {
    const Plane& plane = planes_[face_of_[triangle]];
    return plane.normal.dot(p) - plane.offset;
  }

  /// Brings what sample() will ask for at these points into the cache, for all of them at a time: a query waits for
  /// memory more than it computes. `lists`: for each point the list to ask with, nullptr where there is none yet.
  void prefetch(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> hints,
                std::span<const CandidateList*> lists) const;
  static constexpr std::size_t kMostPrefetched = 64;  ///< points in one call

  std::size_t triangle_count() const { return corners_.size(); }

 private:
  struct Node {
    float lo[3], hi[3];
    std::uint32_t first;  ///< leaf: first slot; inner: right child (left is the next node)
    std::uint32_t count;  ///< 0 = inner
  };
  struct Corner {
    Eigen::Vector3d a, ab, ac;
  };
  /// Triangles that lie in one plane are one face.
  struct Plane {
    Eigen::Vector3d normal;
    double offset = 0;
  };
  void find_faces(const Solid& solid);
  void find_convex_features(const Solid& solid);
  void build(std::uint32_t first, std::uint32_t count, std::vector<std::uint32_t>& ids, const std::vector<Aabb>& boxes,
             const geometry::Poll& poll);
  /// `near_slot`: any triangle that is not far; only affects speed.
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
  double flat_radius(const Eigen::Vector3d& p, const Sample& sample, const CandidateList& list,
                     const FlatnessWanted& wanted) const;

  double near_;
  double coplanar_ = 0;  // distance from a plane that single precision leaves of a flat face
  std::unique_ptr<CandidateCells> cells_;
  std::vector<Node> nodes_;
  std::vector<Corner> corners_;          // by slot: leaves are contiguous
  std::vector<TriangleSlabs> slabs_;     // by slot
  double bounded_within_ = 0;            // slabs_ bound distances of points that are nearer to the origin than this
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
