/// Algorithm 1 as the code published with the paper runs it, by translation and with rotation.
#pragma once

#include <memory>
#include <optional>

#include "level_search.h"

namespace dismantle::bfs {

/// What an unsuccessful search has reached, for a later one among the same fixed parts.
class ReachedLevels final : public SearchState {
 public:
  std::vector<PartId> fixed;  ///< ascending
  std::optional<Levels> translation, rigid;
};

/// `motion: auto`: level by level first by translation, then with rotation, which begins at the second level.
class PublishedSearch final : public PathSearch {
 public:
  PublishedSearch(const PathQuery& query, const Parameters& parameters, RunContext& context);
  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  LevelSearch& search(MotionSpace space);
  std::optional<SearchStatus> run_level(MotionSpace space, const Deadline& end, std::uint64_t pause_after);
  std::uint64_t steps() const;

  const PathQuery& query_;
  const Parameters& parameters_;
  RunContext& context_;
  const ReachedLevels* earlier_ = nullptr;
  std::optional<LevelSearch> translation_, rigid_;
  Deadline deadline_;
  std::uint64_t steps_left_;
  unsigned depth_ = 1;
  bool turning_ = false;  ///< the level of `depth_` has been searched by translation
  PathResult now_;
};

}  // namespace dismantle::bfs
