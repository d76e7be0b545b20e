// Runs the first member of a fallback on this thread, and the others on an idle thread.
#include <algorithm>
#include <utility>

#include "dismantle/executor.h"
#include "portfolio_search.h"

namespace dismantle::portfolio {
namespace {

/// Pauses the speculative searches while a candidate path of the first search is verified: if it is accepted, they are
/// not needed.
class PausingChecker final : public PathChecker {
 public:
  /// Both arguments outlive this.
  PausingChecker(Executor& executor, const PathChecker& checker) : executor_(executor), checker_(checker) {}
  PathCheck check(const Path& path) const override {
    const Executor::PauseScope pause(executor_);
    return checker_.check(path);
  }

 private:
  Executor& executor_;
  const PathChecker& checker_;
};

struct CancelAtEnd {
  const CancelToken& token;
  ~CancelAtEnd() { token.cancel(); }
};

}  // namespace

/// With a step budget each member depends on what the one before it has used, so no member can run speculatively.
bool PortfolioSearch::may_run_beside() const {
  if (!parameters_.speculative || order_.size() < 2 || query_.budget.max_steps > 0) return false;
  if (context_.executor == nullptr || context_.executor->threads() < 2) return false;
  return std::all_of(order_.begin() + 1, order_.end(), [&](const MemberSearch* m) {
    return m->planner().traits().concurrent && !(m->member().when_refused && primary_ == order_.front());
  });
}

/// Results of the others are used only if the first member finds nothing, as if they had begun after its end.
PortfolioSearch::Decision PortfolioSearch::run_beside_first(Portion& portion) {
  RunContext own = context_;
  own.cancel = CancelToken();
  own.on_progress = nullptr;
  own.on_log = nullptr;
  own.speculative = true;
  MemberSearch& first = *order_.front();
  if (!ready(first)) return {};
  for (const MemberSearch* m : order_)
    least_depth(m->member());  // computes the size of the group before two threads need it
  pausing_ = std::make_unique<PausingChecker>(*context_.executor, query_.checker);
  begin(first, context_, *pausing_);
  std::size_t at = 1;
  Portion unlimited;
  Decision rest;
  Executor::TaskHandle beside =
      context_.executor->submit([&] { rest = run_in_order(at, own, unlimited); }, Executor::Priority::fork_join);
  const CancelAtEnd cancel{own.cancel};
  const Decision decision = run_member(first, kUnlimited, portion);
  if (decision.status != SearchStatus::exhausted || decision.by != nullptr) {
    own.cancel.cancel();
    if (!beside.withdraw()) beside.wait();
    for (auto m = order_.begin() + 1; m != order_.end(); ++m) (*m)->reset();
    return decision;
  }
  if (beside.withdraw()) {
    at_ = 1;
    return {};
  }
  beside.wait(context_, own.cancel);
  at_ = order_.size();
  return rest;
}

}  // namespace dismantle::portfolio
