/// The search of one member of a portfolio.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::portfolio {

/// True when a search found nothing, and neither time nor anybody stopped it.
bool in_vain(const PathResult& result);

class MemberSearch {
 public:
  /// `planner` and `member` outlive it. `stream`: 0, or a number for members of a type that another one has, too, so
  /// that their random numbers differ.
  MemberSearch(PathPlanner& planner, const Member& member, std::string name, std::uint64_t stream)
      : planner_(&planner), member_(&member), name_(std::move(name)), stream_(stream) {}

  const Member& member() const { return *member_; }
  PathPlanner& planner() const { return *planner_; }
  const std::string& name() const { return name_; }  ///< id of its type

  bool begun() const { return search_ != nullptr; }
  bool ended() const { return ended_; }  ///< it will not be run again
  void leave_out() { ended_ = true; }
  /// Makes the search. References in `query` outlive this; `context` is copied.
  void begin(const PathQuery& query, const RunContext& context);
  /// Runs it for so many steps and state checks; 0 = no limit. Ends it where it cannot go on.
  SearchStatus run(std::uint64_t steps);
  /// As before begin().
  void reset();

  /// Steps and state checks until now.
  std::uint64_t spent() const { return last_.stats.steps + last_.stats.state_checks; }
  /// What its last run() said.
  const PathResult& last() const { return last_; }
  /// There is more to do, but no budget for it.
  void time_out() { last_.fail(Outcome::timeout); }

 private:
  PathPlanner* planner_;
  const Member* member_;
  std::string name_;
  std::uint64_t stream_;
  std::optional<PathQuery> query_;
  std::optional<RunContext> context_;
  std::unique_ptr<PathSearch> search_;
  PathResult last_ = PathResult::failure(Outcome::depth_limit);
  bool ended_ = false;
};

}  // namespace dismantle::portfolio
