/// A tree of displacements that the verifier tolerates, and what makes a path of a branch of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/tolerance.h"

namespace dismantle::tolerant_walk {

/// Grown by a search, which chooses where to go on and how. Several moving parts move as one rigid body.
class PoseTree {
 public:
  /// A displacement of all moving parts from where they start (node 0); assembly units, world frame.
  struct Node {
    Pose pose;
    Eigen::Vector3d center;  ///< of the moving parts, there
    std::uint32_t parent = 0;
    bool cut = false;                ///< the verifier has refused the way there
    std::optional<PartId> cut_by{};  ///< ... because of that fixed part, if it said so
  };
  /// A small displacement about the centre of the moving parts: of the centre; rotation vector (rad).
  struct Step {
    Eigen::Vector3d way, turn;
  };

  /// A tree as it was when a search ended in vain.
  class Reached final : public SearchState {
   public:
    /// Has what it was stuck at left since? Else it is stuck still: a random tree that begins anew, with other dice, is
    /// worth more than one that goes on from the same dead ends.
    bool has_room_now(const Scene& scene) const;

   private:
    friend class PoseTree;
    struct Lesson {
      PartId part, other;
      Eigen::Vector3d point;
      Pose displacement;
    };
    std::vector<Node> nodes;
    std::vector<Lesson> lessons;
    std::map<PartId, std::uint64_t> touched, stuck_at;
    std::uint64_t looks = 0;  ///< of this search, and of those that it went on from
  };

  /// All three outlive this.
  PoseTree(const Parameters& parameters, const PathQuery& query, RunContext& context, Rng& rng, Overlap overlap,
           GeometryCache& cache);

  const Node& operator[](std::uint32_t node) const { return nodes_[node]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const Eigen::Vector3d& center() const { return center_; }  ///< of the moving parts at the start; world
  double radius() const { return radius_; }                  ///< largest distance of their points from it
  std::uint64_t looks() const { return looks_; }
  /// Looks that need not be made again, thanks to resume().
  std::uint64_t spared() const { return spared_; }
  /// Distances to parts that the looks have taken: one look takes hundreds or tens of thousands.
  std::uint64_t distances() const { return tolerance_.asked(); }
  bool halted() const;
  /// The verifier has refused as often as it may.
  bool given_up() const { return refused_ >= static_cast<std::uint64_t>(parameters_.max_refusals); }

  /// Before anything else: takes over what an earlier search of the same moving parts from the same places has reached
  /// among these fixed parts, and perhaps others. Where these were in the way the verifier has refused nothing.
  void resume(const Reached& reached);
  std::shared_ptr<const Reached> reached() const;

  /// It has just come further than before: what was in its way until now is not what it is stuck at.
  void note_progress() { stuck_at_.clear(); }

  /// Counts as a look.
  bool allowed(const Pose& displacement);
  /// Where a step leads from a node, `scale` times as far.
  Pose after(std::uint32_t node, const Step& step, double scale) const;
  std::uint32_t add(const Pose& pose, std::uint32_t parent);
  /// Are the hulls of what moves and of what stays apart there?
  bool separated(const Pose& displacement) const;

  /// True when the checker accepts a path to the node; then `result` holds it.
  /// Else some nodes on the way there are cut.
  bool verified(std::uint32_t node, PathResult& result);
  /// Nothing was found until now: why.
  void explain(PathResult& result) const;
  /// What a search has found out; `best` is the node that came furthest.
  void finish(std::uint32_t best, PathResult& result) const;
  std::vector<Pose> poses(const Pose& displacement) const;

 private:
  State state(const Pose& displacement) const;
  double distance(const Pose& a, const Pose& b) const;
  std::vector<std::uint32_t> chain_to(std::uint32_t node) const;
  bool straight(const Pose& a, const Pose& b);
  std::vector<Pose> shortened(std::vector<Pose> way);
  Path path_of(const std::vector<Pose>& way) const;
  void cut_off(std::uint32_t node, std::optional<PartId> by);
  void cut(const std::vector<std::uint32_t>& chain, const Pose& near, std::optional<PartId> by);
  void cut_disallowed();

  const Parameters& parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Rng& rng_;
  Deadline deadline_;
  std::unique_ptr<World> world_;
  Tolerance tolerance_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  std::vector<path::Ball> bodies_;
  std::vector<Node> nodes_;
  std::uint64_t looks_ = 0, refused_ = 0, spared_ = 0;
  std::size_t resumed_ = 0;  // nodes
  std::vector<Reached::Lesson> lessons_;
  std::map<PartId, std::uint64_t> touched_, stuck_at_;  // the latter: since there was progress last
};

}  // namespace dismantle::tolerant_walk
