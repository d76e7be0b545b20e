/// A random tree that is led: what is free between the fixed parts says where to go.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "dismantle/free_space/body_points.h"
#include "dismantle/free_space/slips.h"
#include "dismantle/free_space/ways_out.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::free_space {

/// Is what moves so thin that what is allowed for its overlaps would let it pass through walls?
bool overlaps_through(const PathQuery& query);

/// The ways that points of the body still have to go say how far a pose has
/// come: their mean, or that of the foremost ones alone. Poses of the tree are
/// kept by place; the place that has come furthest is gone on from, and the
/// more often that was in vain the less.
class LedWalk final : public PathSearch {
 public:
  /// How long it goes on. Unit of work: a state check that takes 1000
  /// distances; no check counts less than a quarter.
  struct Effort {
    std::size_t cells;  ///< of the grid, about
    double patience;    ///< work without coming further, after which the narrowest
                        ///< place ahead is taken for closed; 12 times as much in all
    unsigned detours;   ///< so often; then it gives up, sooner where the body has
                        ///< only some play
  };
  /// All outlive this. Several moving parts move as one rigid body. Overlaps
  /// near the start only are for what overlaps_through().
  LedWalk(const tolerant_walk::Parameters& parameters, const PathQuery& query, RunContext& context,
          const Effort& effort, tolerant_walk::Overlap overlap, tolerant_walk::GeometryCache& cache);

  /// Does free space lead out from where most of the body is? Else there is nothing to be led by.
  bool leads_out() const { return leads_out_; }
  /// Is there nothing to do, because the body is separated where it starts?
  bool starts_out() { return tree_.separated(Pose{}); }
  /// Outcomes as of tolerant_walk::Walk. Resumes from PathQuery::resume_from
  /// where that is of such a walk.
  SearchStatus run(const Budget& portion) override;
  PathResult result() override;
  std::uint64_t looks() const { return tree_.looks(); }
  /// It has only some play where it starts, by what was found until now.
  bool held() const { return held_; }

 private:
  using PoseTree = tolerant_walk::PoseTree;
  /// Of the way, by rank: mean of the points that are furthest out, one, some, or all of them.
  static constexpr std::size_t kRanks = 4;
  using Left = std::array<double, kRanks>;
  /// Poses of which all points are in the same cells of a coarse grid.
  struct Place {
    std::array<std::uint32_t, kRanks> first{};  ///< the ones that have come furthest, by rank
    Left left{};                                ///< of the way, at these
    std::array<std::uint64_t, kRanks> visits{};
    std::vector<std::uint32_t> nodes;  ///< some others
    std::uint64_t seen = 0;
  };
  using Key = std::vector<std::int32_t>;

  double work() const;
  Left left(const Pose& pose) const;
  double score(const Place& place, std::size_t rank) const;
  void put(std::uint32_t node, const Left& left);
  bool have_ways() const;
  void begin_again();
  bool detour();
  std::uint32_t choose();
  PoseTree::Step along(std::uint32_t node, const Twist& slip) const;
  PoseTree::Step downhill(std::uint32_t node, const std::vector<double>& weights) const;
  std::vector<double> leaders();
  bool gives_up();
  bool fly();
  bool clearly_off(std::uint32_t node) const;
  bool arrived(std::uint32_t node, const Left& left);

  const tolerant_walk::Parameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::vector<BodyPoint> body_;  // world, at the start
  std::vector<Twist> slips_;     // likewise
  WaysOut ways_;
  bool leads_out_, thin_;
  bool held_ = true, moves_ = false;  // only some play was found; thin, and clearly off where it starts
  double place_size_ = 0;
  std::map<Key, std::uint32_t> place_of_;
  std::vector<Place> places_;
  std::array<std::set<std::pair<double, std::uint32_t>>, kRanks> by_score_;  // places
  std::uint32_t best_ = 0;                                                   // the node that has come furthest
  double best_left_ = 0, asked_at_ = 0;  // of the way: there; where it was last asked whether it is out
  Left least_{};                         // where there was progress last, ...
  double progress_at_ = 0;               // ... after so much work
  std::uint64_t first_look_ = 0;         // when the walk began, or the verifier has last refused a way
  double first_work_ = 0;
  bool resumed_ = false, begun_ = false, over_ = false;
  const Effort effort_;
  unsigned detours_ = 0;
  Left at_first_{};  // of the way: where it began
  PathResult result_;
};

}  // namespace dismantle::free_space
