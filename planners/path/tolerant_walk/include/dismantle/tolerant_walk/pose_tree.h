/// A tree of displacements within the verifier's tolerance, and the conversion of its branches to verified paths.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/validity_checker.h"

namespace dismantle::tolerant_walk {

/// A search grows it: it selects nodes and steps. Several moving parts move as one rigid body.
class PoseTree {
 public:
  /// A displacement of all moving parts from where they start (node 0); assembly units, world frame.
  struct Node {
    Pose pose;
    Eigen::Vector3d center;  ///< of the moving parts, there
    std::uint32_t parent = 0;
    bool cut = false;                ///< the verifier has refused the branch to here
    std::optional<PartId> cut_by{};  ///< the fixed part because of which, if known
  };
  /// A small displacement: translation of the centre of the moving parts, and rotation vector about it (rad).
  struct Step {
    Eigen::Vector3d translation, rotation;
  };

  /// The tree of an unsuccessful search.
  class SearchTreeState final : public SearchState {
   public:
    /// Is the part now gone that was the obstacle of at least this share of the invalid poses since the last progress?
    /// If not, a new tree with other random numbers is better than this one, which would stay in its dead ends.
    bool obstacles_removed(const Scene& scene, double share) const;

   private:
    friend class PoseTree;
    struct RefusedPlace {
      PartId part, other;
      Eigen::Vector3d point;
      Pose displacement;
    };
    std::vector<Node> nodes;
    std::vector<RefusedPlace> refused_places;
    std::map<PartId, std::uint64_t> touched, blocked_since_progress;
    std::uint64_t state_checks = 0;  ///< of this search and of those that it resumed
  };

  /// All arguments outlive this.
  PoseTree(const TreeParameters& parameters, const PathQuery& query, RunContext& context, Rng& rng, Overlap overlap,
           GeometryCache& cache);

  const Node& operator[](std::uint32_t node) const { return nodes_[node]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const Eigen::Vector3d& center() const { return center_; }  ///< of the moving parts at the start; world
  double radius() const { return radius_; }                  ///< largest distance of their points from it
  std::uint64_t state_checks() const { return state_checks_; }
  /// State checks that resume() has saved.
  std::uint64_t spared() const { return spared_; }
  /// Distance queries of all state checks: one takes from hundreds to tens of thousands.
  std::uint64_t distance_queries() const { return validity_.distance_queries(); }
  bool halted() const;
  /// The verifier has refused as many paths as it may.
  bool given_up() const { return refused_ >= static_cast<std::uint64_t>(parameters_.max_refusals); }

  /// To be called first. Takes over the tree of an earlier search of the same moving parts from the same poses, among
  /// these fixed parts and others that have left since. Branches that were cut because of those are open again.
  void resume(const SearchTreeState& state);
  std::shared_ptr<const SearchTreeState> search_state() const;

  /// The search has made progress, so the obstacles until now are not what blocks it.
  void note_progress() { blocked_since_progress_.clear(); }

  bool state_valid(const Pose& displacement);
  /// The pose after a step from a node, multiplied by `scale`.
  Pose extended(std::uint32_t node, const Step& step, double scale) const;
  std::uint32_t add(const Pose& pose, std::uint32_t parent);
  /// Are the hulls of the moving and of the fixed parts disjoint?
  bool separated(const Pose& displacement) const;

  /// True when the checker accepts a path to the node; then `result` holds it. Otherwise some nodes of its branch are
  /// cut.
  bool find_verified_path(std::uint32_t node, PathResult& result);
  /// Sets the outcome of a search without success.
  void set_failure(PathResult& result) const;
  /// Sets statistics, obstacles and state. `best`: the node that has come furthest.
  void fill(std::uint32_t best, PathResult& result) const;
  std::vector<Pose> poses(const Pose& displacement) const;

 private:
  State state(const Pose& displacement) const;
  double distance(const Pose& a, const Pose& b) const;
  std::vector<std::uint32_t> branch_to(std::uint32_t node) const;
  bool motion_valid(const Pose& a, const Pose& b);
  std::vector<Pose> shortened(std::vector<Pose> waypoints);
  Path path_of(const std::vector<Pose>& waypoints) const;
  void cut_off(std::uint32_t node, std::optional<PartId> by);
  void cut(const std::vector<std::uint32_t>& chain, const Pose& near, std::optional<PartId> by);
  void cut_invalid();

  const TreeParameters& parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Rng& rng_;
  Deadline deadline_;
  std::unique_ptr<World> world_;
  ValidityChecker validity_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  std::vector<path::Ball> bodies_;
  std::vector<Node> nodes_;
  std::uint64_t state_checks_ = 0, refused_ = 0, spared_ = 0;
  std::size_t resumed_ = 0;  // nodes
  std::vector<SearchTreeState::RefusedPlace> refused_places_;
  std::map<PartId, std::uint64_t> touched_, blocked_since_progress_;  // by fixed part, invalid poses
};

}  // namespace dismantle::tolerant_walk
