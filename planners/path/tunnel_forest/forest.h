/// Trees that grow along contact from the start and from tunnels, until one of them holds the start and a separated
/// state.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/search/candidates.h"
#include "dismantle/search/placed_parts.h"
#include "local_planner.h"
#include "narrow_places.h"
#include "parameters.h"
#include "roadmap.h"

namespace dismantle::tunnel_forest {

class Forest {
 public:
  /// `halted`: true after the deadline or when the run is cancelled. Work without simulation calls it, too.
  Forest(const PathQuery& query, MotionSpace motion, const Parameters& parameters, const Rng& rng,
         std::function<bool()> halted);

  bool starts_separated() { return world_->separated(map_.node(0).state); }
  /// One extension and the joins from its new node. True when the checker accepts a path; `result` then holds it.
  /// Calls `stop` before each push, and returns soon after `stop` returns true.
  bool iterate(PathResult& result, const std::function<bool()>& stop);
  /// Allows initial overlaps everywhere from now on, as the checker does (World::allow_overlap_everywhere). Keeps all
  /// nodes.
  void allow_overlap_everywhere() { world_->allow_overlap_everywhere(); }

  std::uint64_t steps() const { return local_planner_.steps(); }  ///< simulated so far
  std::uint64_t state_checks() const { return state_checks_; }    ///< states measured without simulation
  std::uint64_t refused() const { return refused_; }
  std::uint64_t tunnels() const { return tunnels_; }
  std::size_t size() const { return map_.size(); }
  std::size_t cells() const { return map_.cells(); }  ///< number of explored cells of the space
  double farthest_distance() const { return farthest_distance_; }
  std::vector<Pose> farthest() const { return path::poses_of(map_.node(farthest_).state); }
  /// By fixed part: number of blocked trajectories that touched it where they ended.
  const std::map<PartId, std::uint64_t>& touched() const { return touched_; }

 private:
  using Index = Roadmap::Index;
  /// Centre of the first moving part and its rotation since the start.
  struct Target {
    Eigen::Vector3d center;
    Eigen::Quaterniond turn;
  };

  Roadmap::Node node_of(const State& state);
  Target target_of(Index n) const { return {map_.node(n).center, map_.node(n).turn}; }
  Pose displacement(const Target& target) const { return {target.center - target.turn * center_, target.turn}; }
  std::vector<Pose> poses(const Target& target) const;

  void find_tunnels();
  void add_tunnel_tree(const std::function<bool()>& stop);
  Index choose_tree();
  Index choose_node(Index tree);
  Eigen::Vector3d random_vector();
  Target around(const Target& target, double size);
  Target anywhere();
  /// Adds the nodes of a trajectory from `from` and returns the last; geometry::kNoIndex if the bodies hardly moved.
  Index add_trajectory(Index from, const LocalPlanner::Trajectory& trajectory);
  void try_joins(Index n, const std::function<bool()>& stop);
  bool join(Index n, Index to, const std::function<bool()>& stop);
  void record_contacts(const State& state);

  bool find_verified_path(PathResult& result);
  path::Shown check_forms(const Path& path, unsigned depth, PathResult& result);
  Path retracted(const Path& path);
  Path shortcut(const Path& path);
  bool is_free(const std::vector<Pose>& poses);

  const PathQuery& query_;
  Parameters parameters_;
  std::function<bool()> halted_;
  Rng rng_;
  std::unique_ptr<World> world_;
  bool rigid_, sees_contacts_;
  LocalPlanner local_planner_;
  Eigen::Vector3d center_;  ///< of the first moving part at the start
  double arm_ = 0;          ///< length equivalent to a rotation of 1 rad
  Aabb bounds_;             ///< of the centre
  std::vector<Pose> start_;
  Roadmap map_;
  std::optional<TunnelPoses> tunnel_poses_;
  std::uint64_t iterations_ = 0, state_checks_ = 0, refused_ = 0, tunnels_ = 0, draws_ = 0;
  Index farthest_ = 0;
  double farthest_distance_ = 0;
  std::map<PartId, std::uint64_t> touched_;
};

}  // namespace dismantle::tunnel_forest
