/// The members of a portfolio that participate in a search, and the budget that they share.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "member_search.h"
#include "parameters.h"
#include "participation.h"

namespace dismantle::portfolio {

constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};

/// What is left of one call of PathSearch::run().
struct Portion {
  std::uint64_t left = kUnlimited;  ///< steps and state checks
  Deadline end{};
  bool over() const { return left == 0 || end.passed(); }
};

/// The status, and the member that decided it; null: no member has found a path or failed.
struct Decision {
  SearchStatus status = SearchStatus::exhausted;
  const MemberSearch* by = nullptr;
  /// No member has decided, and the search goes on with the next one.
  bool is_open() const { return status == SearchStatus::exhausted && by == nullptr; }
};

/// The state of each member when it stopped, in the order of the list; null if it was not run.
class PortfolioState final : public SearchState {
 public:
  std::vector<std::shared_ptr<const SearchState>> members;
};

class Members {
 public:
  /// All arguments outlive this. `planners`: one for each member.
  Members(const std::vector<Member>& list, const std::vector<std::shared_ptr<PathPlanner>>& planners,
          const PathQuery& query);
  Members(const Members&) = delete;
  Members& operator=(const Members&) = delete;

  const PathQuery& query() const { return query_; }
  Participation& participation() { return participation_; }
  /// Those that participate, in the order in which they are run.
  const std::vector<MemberSearch*>& order() const { return order_; }
  /// The first of the list that participates; null if none does.
  MemberSearch* primary() const { return primary_; }
  const std::vector<MemberSearch>& all() const { return members_; }

  /// Whether a member may begin: at a sufficient depth, or because paths of the primary member were refused.
  bool ready(const MemberSearch& m);
  void begin(MemberSearch& m, const RunContext& context, const PathChecker& checker);
  /// Makes a member begin if it has not. Nothing if it can be run now, else the decision: the portion or the budget of
  /// the query is used up.
  std::optional<Decision> prepare(MemberSearch& m, const RunContext& context, const Portion& portion);
  /// Runs a member that has begun for at most `most` steps and state checks.
  Decision run(MemberSearch& m, std::uint64_t most, Portion& portion);

 private:
  bool was_refused(const MemberSearch& m) const;
  std::uint64_t budget_left() const;
  std::uint64_t allowance(const MemberSearch& m) const;

  const PathQuery& query_;
  Participation participation_;
  const Deadline deadline_;
  std::vector<MemberSearch> members_;  ///< in the order of the list
  std::vector<MemberSearch*> order_;
  MemberSearch* primary_ = nullptr;
};

}  // namespace dismantle::portfolio
