/// The search of one member of a portfolio.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::portfolio {

class MemberSearch {
 public:
  /// `planner` and `member` outlive this. `stream`: 0 for the first member of a type, different numbers for the others,
  /// so that their random numbers differ.
  MemberSearch(PathPlanner& planner, const Member& member, std::string name, std::uint64_t stream)
      : planner_(&planner), member_(&member), name_(std::move(name)), stream_(stream) {}

  const Member& member() const { return *member_; }
  PathPlanner& planner() const { return *planner_; }
  const std::string& name() const { return name_; }  ///< id of its type

  bool begun() const { return search_ != nullptr; }
  bool ended() const { return ended_; }  ///< it is not run again
  void leave_out() { ended_ = true; }
  /// Makes the search. References in `query` outlive this; `context` is copied.
  void begin(const PathQuery& query, const RunContext& context);
  /// Continues the search for `portion`.
  SearchStatus run(const Budget& portion);
  /// Back to the state before begin().
  void reset();

  /// Steps and state checks so far.
  std::uint64_t spent() const { return last_.stats.steps + last_.stats.state_checks; }
  /// The result after the last run().
  const PathResult& last() const { return last_; }
  /// Sets the outcome for a budget that is used up before the search has ended.
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
