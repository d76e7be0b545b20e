/// The forests of one query: one in R3 and one in SE(3). They grow in turns.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "forest.h"

namespace dismantle::tunnel_forest {

/// Capabilities that the simulator needs.
inline constexpr Capabilities kNeeds{.dynamics = true, .distance = true};

class ForestSearch final : public PathSearch {
 public:
  /// All arguments must outlive this object. Ends with `depth_limit` after `most_steps` simulated steps; with
  /// `exhausted` when the checker has refused too many paths or no forest explores new space.
  ForestSearch(const Parameters& parameters, const PathQuery& query, RunContext& context, std::uint64_t most_steps);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;
  /// Time steps simulated so far.
  std::uint64_t used() const;

 private:
  struct GrowingForest {
    std::unique_ptr<Forest> forest;
    std::uint64_t turn;  ///< steps of the next turn
    std::size_t cells = 0;
    std::int64_t barren_turns = 0;  ///< consecutive turns without new space
    bool overlap_everywhere = false;
  };

  struct Turn {
    std::uint64_t begin = 0;  ///< used() when it began
    std::uint64_t extensions = 0;
  };
  struct PortionEnd {
    std::uint64_t last_step = 0;
    Deadline deadline;
  };

  void add(MotionSpace motion, std::uint64_t stream);
  bool continue_turn(GrowingForest& growing);
  bool portion_over() const;
  bool halted() const;
  bool stopped() const;
  bool given_up() const;
  bool over() const { return stopped() || given_up(); }

  const Parameters parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Deadline deadline_;
  std::vector<GrowingForest> forests_;
  std::size_t current_ = 0;   ///< the forest whose turn it is
  std::optional<Turn> turn_;  ///< the turn in progress
  const std::uint64_t most_steps_;
  PortionEnd portion_;
  PathResult result_;
};

}  // namespace dismantle::tunnel_forest
