/// Algorithm 4: a tree of simulated states that grows by random actions.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "dismantle/ompl/displacement_space.h"
#include "dismantle/ompl/nearest.h"
#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "dismantle/plugin/search_recorder.h"
#include "parameters.h"

namespace dismantle::bk_rrt {

class RandomTree {
 public:
  RandomTree(const PathQuery& query, MotionSpace motion, const Parameters& parameters, const RunContext& context,
             const Rng& rng);

  /// One iteration: random state, nearest node, random action, simulation. True when the checker accepts a path;
  /// `result` then holds it.
  bool iterate(PathResult& result);

  bool starts_separated();
  std::uint64_t steps() const { return steps_; }  ///< simulated time steps so far
  std::uint64_t refused() const { return refused_; }
  std::size_t size() const { return nodes_.size(); }
  double farthest_distance() const { return farthest_distance_; }  ///< of the centre, assembly units
  std::vector<Pose> farthest() const;
  /// By fixed part: number of blocked actions that touched it at their end.
  const std::map<PartId, std::uint64_t>& touched() const { return touched_; }

 private:
  using StateType = sampling::DisplacementSpace::StateType;
  struct Node {
    State state;
    StateType displacement;  ///< of the first moving part
    std::uint32_t parent = 0;
    unsigned depth = 0;
    Path path;  ///< from the parent's state (excluded) to this one (included)
  };
  std::uint32_t add(State state, std::uint32_t parent, Path path);
  StateType displacement_of(const State& state) const;
  Action random_action();
  Path path_to(std::uint32_t node, std::vector<std::uint32_t>& node_of_instant) const;
  bool find_verified_path(std::uint32_t node, PathResult& result);
  void discard(std::uint32_t node);
  void record_contacts(const State& state);

  const PathQuery& query_;
  SearchRecord record_;
  Parameters parameters_;
  Rng rng_;
  std::unique_ptr<World> world_;
  bool sees_contacts_ = false;
  std::unique_ptr<sampling::DisplacementSpace> space_;
  std::vector<path::Ball> bodies_;
  std::vector<Node> nodes_;
  sampling::NearestNodes near_;
  std::uint64_t steps_ = 0, refused_ = 0;
  std::uint32_t farthest_ = 0;
  double farthest_distance_ = 0;
  std::map<PartId, std::uint64_t> touched_;
};

}  // namespace dismantle::bk_rrt
