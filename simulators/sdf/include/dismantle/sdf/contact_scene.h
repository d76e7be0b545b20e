/// Contacts between a few moving parts and the fixed parts, updated as the parts move.
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
  grid,   ///< trilinear interpolation of the grid (as in the paper)
};

/// Depths in assembly units.
struct ContactDepths {
  double threshold = 0;  ///< allowed to all pairs everywhere, on top of their overlap
  /// Limit of the overlap allowed everywhere at first, since a larger one would let a part pass walls thinner than
  /// twice that. A point that is deeper in assembled position keeps its own depth.
  double everywhere = std::numeric_limits<double>::infinity();
  double slack = 0;    ///< allowed depth of a point beyond its assembled depth, at most
  double contact = 0;  ///< error of depth, and of the distance from a convex edge
};

/// Points are culled by motion: each pair and each block of points stores how far the bodies may move before it can be
/// in contact, so the cost of a step depends on the points that can touch. update() does not allocate once its buffers
/// have grown.
class ContactScene {
 public:
  struct Member {
    PartId part = 0;
    const Placed* placed = nullptr;
    Pose pose;  ///< of a fixed part; start pose of a moving one
  };
  /// `margin`: points with a smaller gap are listed. `allowed(a, b)`: depth that the pair may overlap.
  /// allow_overlap_everywhere() allows it to all points; ContactDepths limits it before that call.
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
  /// Range of distance queries, in margins. The block of a point beyond it is not queried until it may be nearer.
  static constexpr double kReach = 20;
  /// A copy with the current members, samples and allowances, without measured contacts.
  ContactScene with_margin(double margin) const;
  /// Also lists the faces around each contact that its point can run into (SurfaceQuery::surroundings), and the
  /// distance that is certainly free of others. Call before the first update; exact distances only.
  void see_surroundings() { surroundings_ = true; }
  bool overlap_is_local() const;  ///< allow_overlap_everywhere() would have an effect
  void allow_overlap_everywhere();

  /// Moves the moving bodies to `poses` and lists all points whose gap is below the margin.
  void update(const std::vector<Pose>& poses, std::vector<ContactPoint>& out);

  const Member& member(std::size_t i) const { return members_[i]; }
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
  struct Scan;
  /// Lists the points of member `owner` near member `surface`.
  void scan(const ContactPair& pair, DirectedContacts& set, std::uint32_t owner, std::uint32_t surface, double odometer,
            std::vector<ContactPoint>& out);
  float assembled_depth(const ContactPair& pair, const Member& owner, const Member& surface,
                        const Eigen::Vector3d& point) const;
  void measure_own_depths(const ContactPair& pair, DirectedContacts& set, const Member& owner,
                          const Member& surface) const;
  /// Data of a point before its distance query.
  struct Near {
    bool surely = false;  ///< near for certain: a bound cannot exclude it, and its last closest triangle is known
    double moved = 0;     ///< motion since its last query
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
  std::vector<double> odometer_;  ///< per moving body: bound of the total motion of its points
  std::vector<ContactPair> pairs_;
  std::vector<AwakePoint> awake_;  ///< points of the set being scanned
  RestContacts* rest_;             ///< nullptr after the first update
  std::uint64_t queries_ = 0;
};

}  // namespace dismantle::sdf
