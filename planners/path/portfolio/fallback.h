/// Members one after the other.
#pragma once

#include <cstddef>
#include <memory>

#include "dismantle/path_planner.h"
#include "members.h"

namespace dismantle::portfolio {

/// A member begins when the one before it has found nothing.
class Fallback {
 public:
  /// `members` outlives this. `speculative`: an idle thread may run the other members concurrently with the first one.
  Fallback(Members& members, bool speculative) : members_(members), speculative_(speculative) {}

  /// Continues where the last call stopped.
  Decision run(const RunContext& context, Portion& portion);

 private:
  bool may_run_beside(const RunContext& context) const;
  Decision run_beside_first(const RunContext& context, Portion& portion);
  Decision run_in_order(std::size_t& at, const RunContext& context, Portion& portion);

  Members& members_;
  const bool speculative_;
  std::size_t at_ = 0;  ///< the member that runs
  std::unique_ptr<PathChecker> pausing_;
};

}  // namespace dismantle::portfolio
