/// A random tree that is led: what is free between the still parts says where to go.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "dismantle/free_space/body_points.h"
#include "dismantle/free_space/ways_out.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::free_space {

/// The mean of the ways that points of the body still have to go says how far a pose has come. Poses of the tree are
/// kept by place; the place that has come furthest is gone on from, and the more often that was in vain the less.
class LedWalk {
 public:
  /// All outlive this. Several moving parts move as one rigid body. The grid has about `most_cells`.
  LedWalk(const tolerant_walk::Parameters& parameters, const PathQuery& query, RunContext& context,
          std::size_t most_cells);

  /// Does free space lead out from where most of the body is? Else there is nothing to be led by.
  bool leads_out() const { return leads_out_; }
  /// Until so many poses were looked at, or 12 times the `patience` is used up. After so much work without coming
  /// further the narrowest place ahead is taken for closed, and after so many detours it gives up; at once where the
  /// body has only some play. Unit of work: a look that takes 1000 distances; no look counts less than a quarter.
  /// Outcomes as of tolerant_walk::Walk.
  PathResult run(std::uint64_t most_looks, double patience, unsigned most_detours);
  std::uint64_t looks() const { return tree_.looks(); }

 private:
  using PoseTree = tolerant_walk::PoseTree;
  /// Poses of which all points are in the same cells of a coarse grid.
  struct Place {
    std::vector<std::uint32_t> nodes;  ///< the one that has come furthest, and some others
    double left = 0;                   ///< of the way, at the first of them
    std::uint64_t seen = 0, visits = 0;
  };
  using Key = std::vector<std::int32_t>;

  double work() const;
  double left(const Pose& pose) const;
  double score(const Place& place) const;
  void put(std::uint32_t node, double left);
  bool have_ways() const;
  void begin_again();
  bool detour();
  std::uint32_t choose();
  PoseTree::Step downhill(std::uint32_t node, const std::vector<double>& weights) const;
  std::vector<double> leaders();
  bool fly(PathResult& result);
  bool arrived(std::uint32_t node, double left);

  const tolerant_walk::Parameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::vector<BodyPoint> body_;  // world, at the start
  WaysOut ways_;
  bool leads_out_;
  double place_size_ = 0;
  std::map<Key, std::uint32_t> place_of_;
  std::vector<Place> places_;
  std::set<std::pair<double, std::uint32_t>> by_score_;  // places
  std::uint32_t best_ = 0;                               // the node that has come furthest
  double best_left_ = 0, asked_at_ = 0;                  // of the way: there; where it was last asked whether it is out
  double least_ = 0;                                     // where there was progress last, ...
  double progress_at_ = 0;                               // ... after so much work
};

}  // namespace dismantle::free_space
