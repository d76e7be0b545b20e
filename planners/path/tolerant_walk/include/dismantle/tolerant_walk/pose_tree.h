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

/// The search that owns the tree selects nodes and steps. Several moving parts move as one rigid body.
class PoseTree {
 public:
  /// A displacement of all moving parts from their start (node 0); assembly units, world frame.
  struct Node {
    Pose pose;
    Eigen::Vector3d center;  ///< of the moving parts at this pose
    std::uint32_t parent = 0;
    bool cut = false;                ///< the verifier has refused the branch to this node
    std::optional<PartId> cut_by{};  ///< the fixed part that caused the refusal, if known
  };
  /// A small displacement: translation of the centre of the moving parts, and rotation vector about it (rad).
  struct Step {
    Eigen::Vector3d translation, rotation;
  };

  /// The tree of an unsuccessful search.
  class SearchTreeState final : public SearchState {
   public:
    /// True if parts that have left caused at least this share of the invalid poses of that search. Otherwise
    /// a new tree with other random numbers is better: this one would stay in its dead ends.
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
    std::map<PartId, std::uint64_t> touched, blocked;
    std::uint64_t state_checks = 0;  ///< including those of the searches that it resumed
  };

  /// All arguments must outlive this object.
  PoseTree(const TreeParameters& parameters, const PathQuery& query, RunContext& context, Rng& rng,
           GeometryCache& cache);

  const Node& operator[](std::uint32_t node) const { return nodes_[node]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const Eigen::Vector3d& center() const { return center_; }  ///< of the moving parts at the start, in the world
  double radius() const { return radius_; }                  ///< largest distance of a moving part's point from it
  std::uint64_t state_checks() const { return state_checks_; }
  /// State checks that resume() has saved.
  std::uint64_t spared() const { return spared_; }
  bool halted() const;
  /// The number of refused paths has reached its limit.
  bool given_up() const { return refused_ >= static_cast<std::uint64_t>(parameters_.max_refusals); }

  /// Call it before any other function. Takes over the tree of an earlier search for the same moving parts at the same
  /// poses, with these fixed parts and others that have left since. Reopens branches that were cut because of the
  /// latter.
  void resume(const SearchTreeState& state);
  std::shared_ptr<const SearchTreeState> search_state() const;

  bool state_valid(const Pose& displacement);
  /// The pose after a step from a node; the step is multiplied by `scale`.
  Pose extended(std::uint32_t node, const Step& step, double scale) const;
  std::uint32_t add(const Pose& pose, std::uint32_t parent);
  /// True if the hulls of the moving and of the fixed parts are disjoint.
  bool separated(const Pose& displacement) const;

  /// True if the checker accepts a path to the node; `result` then holds it. Otherwise nodes of its branch are cut.
  bool find_verified_path(std::uint32_t node, PathResult& result);
  /// Sets the outcome of a search without success.
  void set_failure(PathResult& result) const;
  /// Sets statistics, obstacles and search state. `best`: the node furthest from the start.
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
  std::size_t resumed_ = 0;  // number of nodes taken over by resume()
  std::vector<SearchTreeState::RefusedPlace> refused_places_;
  std::map<PartId, std::uint64_t> touched_,
      blocked_;  // number of invalid poses by fixed part; without those of resumed searches
};

}  // namespace dismantle::tolerant_walk
