/// A random tree of poses that descends a navigation function.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "dismantle/free_space/medial_balls.h"
#include "dismantle/free_space/navigation_function.h"
#include "dismantle/free_space/parameters.h"
#include "dismantle/geometry/twist.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::free_space {

/// True if the moving group is thinner than its initial overlap: it could pass through walls where that overlap is
/// allowed.
bool thinner_than_overlap(const PathQuery& query, std::int64_t control_points = SearchParameters{}.control_points);

/// The value of a pose is the mean of the navigation function over all control points of the body, or over the foremost
/// ones. Poses are grouped by projection cells, as in KPIECE: the cell with the best value is extended, and each visit
/// makes its value worse.
class NavigationSearch final : public PathSearch {
 public:
  /// Limits at which the search gives up. Unit of work: 1000 distance queries; a state check counts at least a quarter.
  struct Effort {
    double patience;   ///< work without progress, after which the narrowest place ahead is blocked
    unsigned detours;  ///< number of places that may be blocked
  };
  /// All arguments outlive this. Several moving parts move as one rigid body.
  NavigationSearch(const SearchParameters& parameters, const PathQuery& query, RunContext& context,
                   const Effort& effort, tolerant_walk::Overlap overlap, tolerant_walk::GeometryCache& cache);

  /// True if most of the body has a route to the outside. Otherwise no search is possible.
  bool has_route_out() const { return has_route_out_; }
  /// True if the body is separated at the start already.
  bool starts_separated() { return tree_.separated(Pose{}); }
  /// Outcomes: see tolerant_walk::RrtSearch. Resumes from PathQuery::resume_from if that is the state of such a
  /// search.
  SearchStatus run(const Budget& portion) override;
  PathResult result() override;
  std::uint64_t state_checks() const { return tree_.state_checks(); }
  /// True as long as the body has shown no more than some play at the start.
  bool only_play() const { return only_play_; }

 private:
  using PoseTree = tolerant_walk::PoseTree;
  /// Subsets of the control points by which poses are ranked: the foremost one, a quarter, a half, all of them.
  static constexpr std::size_t kRanks = 4;
  /// Mean remaining length of the route, by rank.
  using Remaining = std::array<double, kRanks>;
  /// A group of poses whose control points lie in the same cells of a coarse grid.
  struct ProjectionCell {
    std::array<std::uint32_t, kRanks> best{};  ///< the node that has come furthest, by rank
    Remaining remaining{};                     ///< of these nodes
    std::array<std::uint64_t, kRanks> visits{};
    std::vector<std::uint32_t> nodes;  ///< a uniform sample of its nodes
    std::uint64_t size = 0;            ///< number of its nodes
  };
  using Key = std::vector<std::int32_t>;

  double work() const;
  double longest_step() const { return parameters_.longest_step * parameters_.step; }
  Remaining remaining(const Pose& pose) const;
  double score(const ProjectionCell& cell, std::size_t rank) const;
  void insert(std::uint32_t node, const Remaining& remaining);
  bool route_from_body() const;
  void rebuild_cells();
  bool detour();
  std::uint32_t select_node();
  PoseTree::Step slippage_step(std::uint32_t node, const geometry::Twist& motion) const;
  PoseTree::Step descent_step(std::uint32_t node, const std::vector<double>& weights) const;
  std::vector<double> sample_weights();
  bool should_give_up();
  bool extend();
  bool thin_and_moved(std::uint32_t node) const;
  bool is_goal(std::uint32_t node, const Remaining& remaining);

  const SearchParameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::vector<MedialBall> control_points_;          // world, at the start
  std::vector<geometry::Twist> slippable_motions_;  // world, at the start
  NavigationFunction navigation_;
  bool has_route_out_, thin_;
  bool only_play_ = true, thin_moved_ = false;
  double projection_cell_size_ = 0;
  std::map<Key, std::uint32_t> cell_of_key_;
  std::vector<ProjectionCell> cells_;
  std::array<std::set<std::pair<double, std::uint32_t>>, kRanks> cells_by_score_;
  std::uint32_t best_ = 0;                           // the node that has come furthest
  double best_remaining_ = 0, goal_checked_at_ = 0;  // remaining length at `best_`, and at the last goal check
  Remaining least_{};                                // at the last progress
  double progress_at_ = 0;                           // work at the last progress
  std::uint64_t first_check_ = 0;                    // state checks and work at the start, or at the last refusal
  double first_work_ = 0;
  bool resumed_ = false, begun_ = false, over_ = false;
  const Effort effort_;
  unsigned detours_ = 0;
  Remaining at_start_{};
  PathResult result_;
};

}  // namespace dismantle::free_space
