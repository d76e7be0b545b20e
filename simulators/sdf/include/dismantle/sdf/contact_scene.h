/// Contacts between a few moving parts and those that stand still, kept up to date while they move.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/sdf/shape.h"
#include "dismantle/simulator.h"

namespace dismantle::sdf {

enum class DistanceModel {
  exact,  ///< closest triangle near the surface: no field error
  grid,   ///< trilinear interpolation of the grid (the paper's)
};

/// One sample point near or below a surface. The gap is linear in small motions of the bodies:
/// gap(x) = gap + sum over its bodies of sign * normal . (v + w x arm).
struct ContactPoint {
  double gap = 0;            ///< signed distance plus what the pair may overlap; < 0 = in contact
  Eigen::Vector3d normal;    ///< world, unit, out of the surface that is touched
  Eigen::Vector3d point;     ///< world
  int owner = -1;            ///< moving body that carries the point, -1 = a part that stands still
  int surface = -1;          ///< moving body that carries the surface, likewise
  PartId owner_part = 0, surface_part = 0;
  /// At convex edges and corners of the surface: the faces that meet there. The point is free as soon as
  /// it is outside of one of them: gap(x) is the largest of all.
  int plane_count = 0;
  FacePlane planes[kMaxPlanes];  ///< normals in world axes, gaps as above
};

/// Points are culled by motion: each pair, then each block of points, remembers how far the bodies may
/// move before it can matter, so that the work of a step follows the points that can touch. Once warm,
/// update() allocates nothing.
class ContactScene {
 public:
  struct Member {
    PartId part = 0;
    const Placed* placed = nullptr;
    Pose pose;  ///< of a still part; start pose of a moving one
  };
  /// `margin`: points with a gap below it are listed. `allowed(a, b)`: depth that the pair had when assembled.
  template <class Allowed>
  ContactScene(std::vector<Member> moving, std::vector<Member> still, DistanceModel model, double margin,
               const Allowed& allowed)
      : model_(model), margin_(margin) {
    set_members(std::move(moving), std::move(still));
    for (auto& pair : pairs_) pair.allowed = allowed(members_[pair.a].part, members_[pair.b].part);
  }

  /// Moves the moving bodies to `poses` and lists all points whose gap is below the margin.
  void update(const std::vector<Pose>& poses, std::vector<ContactPoint>& out);

  std::size_t moving_count() const { return moving_; }
  const Member& member(std::size_t i) const { return members_[i]; }
  std::size_t member_count() const { return members_.size(); }
  /// Mass centre of moving body i in its assembled frame; and its bounding radius about it.
  Eigen::Vector3d center(std::size_t i) const { return members_[i].placed->rest * members_[i].placed->shape->mass.center; }
  double radius(std::size_t i) const { return members_[i].placed->shape->radius; }
  /// Adds a sample at `point` (assembled frame of `part`) against `other`.
  void add_point(PartId part, PartId other, const Eigen::Vector3d& point);
  std::uint64_t distance_queries() const { return queries_; }

 private:
  /// Points of one member against the solids of another.
  struct Directed {
    bool ready = false;
    std::vector<double> wake;             ///< per block: odometer reading at which it may matter
    std::vector<std::uint32_t> hint;      ///< per point and solid: last closest triangle
    std::vector<Eigen::Vector3d> extra;   ///< learned points, owner's shape frame
    std::vector<std::uint32_t> extra_hint;
  };
  struct Pair {
    std::uint32_t a = 0, b = 0;  ///< members; a is moving
    double allowed = 0;
    double wake = 0;             ///< odometer reading at which the boxes may meet
    Directed ab, ba;             ///< points of a on b, points of b on a
  };

  void set_members(std::vector<Member> moving, std::vector<Member> still);
  void scan(Pair& pair, Directed& set, std::uint32_t owner, std::uint32_t surface, double margin, double odometer,
            std::vector<ContactPoint>& out);
  double signed_distance(const SolidField& field, const Eigen::Vector3d& p, double limit, std::uint32_t& hint,
                         Sample& sample);

  DistanceModel model_;
  double margin_;
  std::size_t moving_ = 0;
  std::vector<Member> members_;  ///< moving first
  std::vector<Pose> world_;      ///< shape frame -> world, now
  std::vector<Aabb> boxes_;      ///< world, now
  std::vector<double> odometer_; ///< per moving body: way that its points may have travelled in all
  std::vector<Pair> pairs_;
  std::uint64_t queries_ = 0;
};

/// Largest depth of any contact point of the two parts in each other when assembled, >= 0.
double assembled_overlap(const Placed& a, const Placed& b);

}  // namespace dismantle::sdf
