/// The scene of one attempt: collisions and depths.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "body.h"
#include "dismantle/simulator.h"
#include "edge_depth.h"
#include "parameters.h"

namespace dismantle::mesh_collision {

class PreparedBodies final : public PreparedAssembly {
 public:
  std::vector<PlacedBody> placed;                        ///< by part
  std::map<std::pair<PartId, PartId>, double> overlaps;  ///< a < b: InitialOverlap::allowed(); assembly units
  double overlap(PartId a, PartId b) const {
    const auto found = overlaps.find(std::minmax(a, b));
    return found == overlaps.end() ? 0.0 : found->second;
  }
};

/// Collision and depth between placed bodies, with buffers. One per thread.
class PairCheck {
 public:
  explicit PairCheck(const Parameters& parameters) : parameters_(parameters) {}

  /// True if the parts share a point. Exact for the given triangles; includes touching and containment.
  bool collide(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b);
  /// Depth beyond `allowed`, >= 0. Parameters::certified_depth if that bound was proved, else measured.
  double depth(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double allowed);
  /// Measures the deepest edge point of one part in the other, both ways. Stops at the depth `enough`.
  double measure(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double enough);
  /// True proves that no surface point of one is deeper than `depth` in the other. False for bodies without an inset of
  /// that depth.
  bool certify(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double depth);

 private:
  bool contained(const Body& a, const Pose& a_to_b, const Body& b);
  bool inset_is_clear(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double depth);

  Parameters parameters_;
  Collider collider_;
  DepthGauge gauge_;
  std::vector<TrianglePair> pairs_;
  std::vector<std::uint32_t> corners_;
};

class MeshWorld final : public World {
 public:
  MeshWorld(const PreparedBodies& prepared, const Scene& scene, MotionSpace space, const Parameters& parameters);

  const Scene& scene() const override { return scene_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override;
  Eigen::Vector3d center(std::size_t body) const override {
    return moving_[body].placed->rest * moving_[body].placed->body->center;
  }
  double radius(std::size_t body) const override { return moving_[body].placed->body->radius; }
  double torque_arm(std::size_t body) const override { return radius(body); }
  [[noreturn]] StepReport advance(State& state, const Action& action, double duration, Trace* trace) override;
  double penetration(const State& state) override;
  [[noreturn]] void contacts(const State& state, std::vector<Contact>& out) override;
  bool separated(const State& state) override;
  bool body_separated(const State& state, std::size_t body) override;
  void add_contact_sample(PartId, PartId, const Eigen::Vector3d&) override {}  // this simulator uses no samples

 private:
  struct Member {
    PartId part = 0;
    const PlacedBody* placed = nullptr;
    Pose pose;  ///< shape frame to world: current (moving) or constant (fixed)
    Aabb box;   ///< world, at the same time as `pose`
  };
  void place(const State& state);

  Scene scene_;
  MotionSpace space_;
  double depth_limit_ = 0;
  double separation_gap_;  // of separated hulls; assembly units
  PairCheck check_;
  std::vector<Member> moving_, fixed_;
  std::vector<double> allowed_;  ///< [moving * (fixed + moving) + other]
  std::vector<Eigen::Vector3d> rest_hull_;
  Aabb rest_box_;
  std::vector<Eigen::Vector3d> moving_hull_;  // scratch
};

/// Box of a box after a rigid motion.
Aabb moved_box(const Aabb& box, const Pose& pose);

}  // namespace dismantle::mesh_collision
