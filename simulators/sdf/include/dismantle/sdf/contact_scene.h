/// Contacts between a few moving parts and those that stay fixed, kept up to date while they move.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "dismantle/sdf/contact_pair.h"
#include "dismantle/sdf/shape.h"
#include "dismantle/simulator.h"

namespace dismantle::sdf {

enum class DistanceModel {
  exact,  ///< closest triangle near the surface: no field error
  grid,   ///< trilinear interpolation of the grid (the paper's)
};

/// Depths in assembly units.
struct ContactDepths {
  double threshold = 0;  ///< granted to all pairs everywhere, on top of their overlap
  /// A larger overlap is not granted everywhere from the start, since it would let a part through walls that are thinner than
  /// twice that: at first each point may be as deep as it was when assembled, and other points this deep.
  double everywhere = std::numeric_limits<double>::infinity();
  double slack = 0;    ///< what each point may be deeper than when assembled
  double contact = 0;  ///< depth, and distance from a convex edge, by which contact may be off
};

/// Points are culled by motion: each pair, then each block of points, remembers how far the bodies may
/// move before it can matter, so that the work of a step follows the points that can touch. Once warm,
/// update() allocates nothing.
class ContactScene {
 public:
  struct Member {
    PartId part = 0;
    const Placed* placed = nullptr;
    Pose pose;  ///< of a fixed part; start pose of a moving one
  };
  /// `margin`: points with a gap below it are listed. `allowed(a, b)`: depth that the pair may overlap.
  /// allow_overlap_everywhere() grants that depth to all points; see ContactDepths for before.
  ///
  /// `rest`: contacts of the assembled pairs, for scenes of the same shapes, model, margin, slack and allowances.
  template <class Allowed>
  ContactScene(std::vector<Member> moving, std::vector<Member> fixed, DistanceModel model, double margin,
               const Allowed& allowed, const ContactDepths& depths = {}, RestContacts* rest = nullptr)
      : model_(model), margin_(margin), reach_(kReach * margin), depths_(depths), rest_(rest) {
    set_members(std::move(moving), std::move(fixed));
    for (auto& pair : pairs_) {
      const double overlap = allowed(members_[pair.a].part, members_[pair.b].part);
      pair.allowed = overlap + depths.threshold;
      pair.everywhere = std::min(overlap, depths.everywhere) + depths.threshold;
    }
  }
  /// Margins beyond which a query gives up, and the block of the point is not asked for until it may be nearer.
  static constexpr double kReach = 20;
  /// The same members, samples and allowances as they are now, with nothing measured yet.
  ContactScene with_margin(double margin) const;
  /// Also lists the faces around each contact that its point can run into (SurfaceQuery::surroundings), and tells how
  /// far it can go for certain. To be called before the first update; exact distances only.
  void see_surroundings() { surroundings_ = true; }
  bool overlap_is_local() const;  ///< allow_overlap_everywhere() would grant something
  void allow_overlap_everywhere();

  /// Moves the moving bodies to `poses` and lists all points whose gap is below the margin.
  void update(const std::vector<Pose>& poses, std::vector<ContactPoint>& out);

  std::size_t moving_count() const { return moving_; }
  const Member& member(std::size_t i) const { return members_[i]; }
  std::size_t member_count() const { return members_.size(); }
  /// Mass centre of moving body i in its assembled frame; and its bounding radius about it.
  Eigen::Vector3d center(std::size_t i) const {
    return members_[i].placed->rest * members_[i].placed->shape->mass.center;
  }
  double radius(std::size_t i) const { return members_[i].placed->shape->radius; }
  /// Adds a sample at `point` (assembled frame of `part`) against `other`.
  void add_point(PartId part, PartId other, const Eigen::Vector3d& point);
  std::uint64_t distance_queries() const { return queries_; }

 private:
  void set_members(std::vector<Member> moving, std::vector<Member> fixed);
  void update_pair(ContactPair& pair, std::vector<ContactPoint>& out);
  void begin_at_rest(std::vector<ContactPoint>& out);
  void scan(ContactPair& pair, DirectedContacts& set, std::uint32_t owner, std::uint32_t surface, double margin,
            double odometer, std::vector<ContactPoint>& out);
  float assembled_depth(const ContactPair& pair, const Member& owner, const Member& surface,
                        const Eigen::Vector3d& point) const;
  void measure_own_depths(const ContactPair& pair, DirectedContacts& set, const Member& owner,
                          const Member& surface) const;
  /// What is known of a point before it is asked for.
  struct Near {
    bool surely = false;  ///< bounds of its distance would not do, and its last closest triangle is known
    double way = 0;       ///< from where it was last asked for
    const CandidateList* list = nullptr;
  };
  /// A point whose distance has to be measured.
  struct AwakePoint {
    std::uint32_t index = 0, block = 0;
    bool linear = false;  ///< is_linear_at()
    Eigen::Vector3d at;   ///< frame of the surface
    Near near;
  };
  static void find_lists(const SurfaceQuery& surface, const DirectedContacts& set, std::span<AwakePoint> points);
  Sample signed_distance(const SolidField& field, const Eigen::Vector3d& p, double limit,
                         const FlatnessWanted& flatness, std::uint32_t& hint, const Near& near);

  DistanceModel model_;
  double margin_, reach_;
  ContactDepths depths_;
  bool surroundings_ = false;
  std::size_t moving_ = 0;
  std::vector<Member> members_;   ///< moving first
  std::vector<Pose> world_;       ///< shape frame -> world, now
  std::vector<Aabb> boxes_;       ///< world, now
  std::vector<double> odometer_;  ///< per moving body: way that its points may have travelled in all
  std::vector<ContactPair> pairs_;
  std::vector<AwakePoint> awake_;  ///< of the set that is scanned
  RestContacts* rest_;             ///< nullptr once the scene has begun
  std::uint64_t queries_ = 0;
};

}  // namespace dismantle::sdf
