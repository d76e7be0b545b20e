/// Trees that grow along contact from the start and from tunnels, until one of them holds the start and a state that
/// is out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path/candidates.h"
#include "dismantle/path/placed_parts.h"
#include "dismantle/path_planner.h"
#include "guide.h"
#include "narrow_places.h"
#include "parameters.h"
#include "roadmap.h"

namespace dismantle::tunnel_forest {

class Forest {
 public:
  /// `halted`: there is no time left, or somebody wants an end; work that is no simulation asks it, too.
  Forest(const PathQuery& query, MotionSpace motion, const Parameters& parameters, const Rng& rng,
         std::function<bool()> halted);

  bool starts_out() { return world_->separated(map_.node(0).state); }
  /// One extension, and what joins follow from it. True when that led to a path
  /// that the checker accepts; then `result` holds it. `stop` is asked before
  /// each push; once it says so, this returns soon.
  bool iterate(PathResult& result, const std::function<bool()>& stop);
  /// Grants what the checker does where parts overlap (World::allow_overlap_everywhere). Nodes
  /// stay as they are.
  void allow_overlap_everywhere() { world_->allow_overlap_everywhere(); }

  std::uint64_t steps() const { return guide_.steps(); }  ///< simulated so far
  std::uint64_t looks() const { return looks_; }          ///< states that were measured without simulation
  std::uint64_t refused() const { return refused_; }
  std::uint64_t tunnels() const { return tunnels_; }
  std::size_t size() const { return map_.size(); }
  std::size_t cells() const { return map_.cells(); }  ///< how much of the space has been seen
  double farthest_way() const { return farthest_way_; }
  std::vector<Pose> farthest() const { return path::poses_of(map_.node(farthest_).state); }
  /// How often each fixed part was touched where a trip ended.
  const std::map<PartId, std::uint64_t>& touched() const { return touched_; }

 private:
  using Index = Roadmap::Index;
  /// Where to: centre of the first moving part and its turn since the start.
  struct Target {
    Eigen::Vector3d center;
    Eigen::Quaterniond turn;
  };

  Roadmap::Node node_of(const State& state);
  Target place(Index n) const { return {map_.node(n).center, map_.node(n).turn}; }
  Pose displacement(const Target& target) const { return {target.center - target.turn * center_, target.turn}; }
  std::vector<Pose> poses(const Target& target) const;

  void look_for_tunnels();
  void plant_tunnel(const std::function<bool()>& stop);
  Index choose_tree();
  Index choose_node(Index tree);
  Eigen::Vector3d random_vector();
  Target around(const Target& target, double size);
  Target anywhere();
  /// Adds what a trip from `from` has led to; kNone when it has led nowhere new.
  Index keep(Index from, const Guide::Trip& trip);
  void try_joins(Index n, const std::function<bool()>& stop);
  bool join(Index n, Index to, const std::function<bool()>& stop);
  void note_contacts(const State& state);

  bool verified(PathResult& result);
  path::Shown show(const Path& path, unsigned depth, PathResult& result);
  Path eased(const Path& path);
  Path shortcut(const Path& path);
  bool is_free(const std::vector<Pose>& poses);

  const PathQuery& query_;
  Parameters parameters_;
  std::function<bool()> halted_;
  Rng rng_;
  std::unique_ptr<World> world_;
  bool rigid_, sees_contacts_;
  Guide guide_;
  Eigen::Vector3d center_;  ///< of the first moving part, where it starts
  double arm_ = 0;          ///< way that stands for a turn of 1 rad
  Aabb bounds_;             ///< of the centre
  std::vector<Pose> start_;
  Roadmap map_;
  std::optional<TunnelPoses> tunnel_poses_;
  std::uint64_t iterations_ = 0, looks_ = 0, refused_ = 0, tunnels_ = 0, draws_ = 0;
  Index farthest_ = 0;
  double farthest_way_ = 0;
  std::map<PartId, std::uint64_t> touched_;
};

}  // namespace dismantle::tunnel_forest
