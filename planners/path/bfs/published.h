/// Algorithm 1 as implemented in the code published with the paper, by translation and with rotation.
#pragma once

#include <memory>
#include <optional>

#include "level_search.h"

namespace dismantle::bfs {

/// The levels of an unsuccessful search, for a later search among the same fixed parts.
class ReachedLevels final : public SearchState {
 public:
  std::vector<PartId> fixed;  ///< ascending
  std::optional<Levels> translation, rigid;
};

/// With `motion: auto`, searches each level by translation first. From the second level on, rotation follows.
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
