/// A search that several planners carry out together.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "member_search.h"
#include "parameters.h"

namespace dismantle::portfolio {

/// The state of each member when it stopped, in the order of the list; null if it was not run.
class PortfolioState final : public SearchState {
 public:
  std::vector<std::shared_ptr<const SearchState>> members;
};

class PortfolioSearch final : public PathSearch {
 public:
  /// All arguments outlive this. `planners`: one for each member.
  PortfolioSearch(const Parameters& parameters, const std::vector<std::shared_ptr<PathPlanner>>& planners,
                  const PathQuery& query, RunContext& context);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  static constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};
  /// Budget that is left of one call of run().
  struct Portion {
    std::uint64_t steps_left = kUnlimited;
  };
  /// The status, and the member that decided it; null: no member has found a path or failed.
  struct Decision {
    SearchStatus status = SearchStatus::exhausted;
    const MemberSearch* by = nullptr;
  };

  void choose_members();
  bool takes_part(const MemberSearch& m);
  bool is_large(const Member& member);
  std::uint64_t least_depth(const Member& member);
  bool was_refused(const MemberSearch& m) const;
  bool ready(const MemberSearch& m);

  Decision fall_back(Portion& portion);
  Decision run_in_order(std::size_t& at, const RunContext& context, Portion& portion);
  Decision run_beside_first(Portion& portion);
  bool may_run_beside() const;
  Decision alternate(Portion& portion);
  Decision take_turn(MemberSearch& m, Portion& portion);
  void begin(MemberSearch& m, const RunContext& context, const PathChecker& checker);
  Decision run_member(MemberSearch& m, std::uint64_t turn, Portion& portion);

  std::uint64_t budget_left() const;
  std::uint64_t allowance(const MemberSearch& m) const;

  const Parameters& parameters_;
  const PathQuery& query_;
  RunContext& context_;
  const bool limited_;  ///< the query has a depth limit
  Deadline deadline_;
  std::vector<MemberSearch> members_;                   ///< in the order of the list
  std::vector<MemberSearch*> order_;                    ///< those that participate, in the order in which they are run
  MemberSearch* primary_ = nullptr;                     ///< the first of the list that participates
  std::optional<std::pair<double, double>> diagonals_;  ///< of the boxes of the moving and of the fixed parts
  std::unique_ptr<PathChecker> pausing_;
  std::size_t at_ = 0;            ///< the member whose turn it is, in `order_`
  std::uint64_t turn_ = 0;        ///< `alternate`: length of the turns of this round
  std::uint64_t turn_began_ = 0;  ///< work of the member when its turn began
  bool in_turn_ = false;          ///< a portion ended before the turn did
  bool short_round_ = false;      ///< the first member has a short turn
  SearchStatus status_ = SearchStatus::paused;
  const MemberSearch* decided_by_ = nullptr;
  PathResult refusal_;  ///< result if no member participates
};

}  // namespace dismantle::portfolio
