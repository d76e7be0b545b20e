/// A search that several planners carry out together.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "fallback.h"
#include "members.h"
#include "parameters.h"
#include "rounds.h"

namespace dismantle::portfolio {

class PortfolioSearch final : public PathSearch {
 public:
  /// All arguments outlive this. `planners`: one for each member.
  PortfolioSearch(const Parameters& parameters, const std::vector<std::shared_ptr<PathPlanner>>& planners,
                  const PathQuery& query, RunContext& context);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  const Parameters& parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Members members_;
  std::optional<Rounds> rounds_;  ///< one of these two, from the first run() on
  std::optional<Fallback> fallback_;
  SearchStatus status_ = SearchStatus::paused;
  const MemberSearch* decided_by_ = nullptr;
  PathResult refusal_;  ///< result if no member participates
};

}  // namespace dismantle::portfolio
