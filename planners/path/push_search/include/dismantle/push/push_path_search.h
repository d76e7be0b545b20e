/// Push search in portions.
#pragma once

#include <cstdint>
#include <optional>

#include "dismantle/path_planner.h"
#include "dismantle/push/plan.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// Without a depth limit, and with `motion: auto`, a portion that ends is gone on from, after the state in hand. Else a
/// portion that is too small begins anew with the next, larger one.
class PushPathSearch final : public PathSearch {
 public:
  /// All outlive it.
  PushPathSearch(const PathQuery& query, const Tactics& tactics, RunContext& context);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  SearchStatus run_turns(const Budget& portion);
  SearchStatus run_whole(const Budget& portion);

  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  Deadline deadline_;
  std::uint64_t steps_left_;
  std::optional<ByTurns> turns_;
  PathResult last_ = PathResult::failure(Outcome::depth_limit);
  SearchStatus status_ = SearchStatus::paused;
};

}  // namespace dismantle::push
