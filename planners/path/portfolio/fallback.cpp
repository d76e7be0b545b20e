#include "fallback.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/edge_checker.h"

namespace dismantle::portfolio {
namespace {

/// Pauses the speculative searches while a candidate path of the first search is verified: if it is accepted, they are
/// not needed.
class PausingChecker final : public PathChecker, public geometry::EdgeChecker {
 public:
  /// Both arguments outlive this.
  PausingChecker(Executor& executor, const PathChecker& checker) : executor_(executor), checker_(checker) {}
  PathCheck check(const Path& path) const override {
    const Executor::PauseScope pause(executor_);
    return checker_.check(path);
  }
  PathCheck check_edge(const std::vector<Pose>& from, const std::vector<Pose>& to) const override {
    if (const geometry::EdgeChecker* edges = geometry::edge_checker(checker_)) return edges->check_edge(from, to);
    PathCheck answer;
    answer.reason = "this checker checks whole paths only";
    return answer;
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
bool Fallback::may_run_beside(const RunContext& context) const {
  const auto& order = members_.order();
  if (!speculative_ || order.size() < 2 || members_.query().budget.max_steps > 0) return false;
  if (context.executor == nullptr || context.executor->threads() < 2) return false;
  return std::all_of(order.begin() + 1, order.end(), [&](const MemberSearch* m) {
    return m->planner().traits().concurrent && !(m->member().when_refused && members_.primary() == order.front());
  });
}

/// Runs the first member on this thread, and the others on an idle thread. Results of the others are used only if the
/// first member finds nothing, as if they had begun after its end.
Decision Fallback::run_beside_first(const RunContext& context, Portion& portion) {
  RunContext own = context;
  own.cancel = CancelToken();
  own.on_progress = nullptr;
  own.on_log = nullptr;
  own.speculative = true;
  const auto& order = members_.order();
  MemberSearch& first = *order.front();
  if (!members_.ready(first)) return {};
  for (const MemberSearch* m : order)
    members_.participation().deep_enough(m->member());  // computes the size of the group before two threads need it
  pausing_ = std::make_unique<PausingChecker>(*context.executor, members_.query().checker);
  members_.begin(first, context, *pausing_);
  std::size_t at = 1;
  Portion unlimited;
  Decision rest;
  Executor::TaskHandle beside =
      context.executor->submit([&] { rest = run_in_order(at, own, unlimited); }, Executor::Priority::fork_join);
  const CancelAtEnd cancel{own.cancel};
  const Decision decision = members_.run(first, kUnlimited, portion);
  if (!decision.is_open()) {
    own.cancel.cancel();
    if (!beside.withdraw()) beside.wait();
    for (auto m = order.begin() + 1; m != order.end(); ++m) (*m)->reset();
    return decision;
  }
  if (beside.withdraw()) {
    at_ = 1;
    return {};
  }
  beside.wait(context, own.cancel);
  at_ = order.size();
  return rest;
}

Decision Fallback::run(const RunContext& context, Portion& portion) {
  const bool begins = at_ == 0 && !members_.order().front()->begun();
  const bool limited = portion.left != kUnlimited || std::isfinite(portion.end.seconds_left());
  if (begins && !limited && may_run_beside(context)) {
    const Decision first = run_beside_first(context, portion);
    if (!first.is_open()) return first;
  }
  return run_in_order(at_, context, portion);
}

Decision Fallback::run_in_order(std::size_t& at, const RunContext& context, Portion& portion) {
  for (; at < members_.order().size(); ++at) {
    MemberSearch& m = *members_.order()[at];
    if (!m.begun() && !members_.ready(m)) m.leave_out();
    while (!m.ended()) {
      if (const auto ends = members_.prepare(m, context, portion)) return *ends;
      const Decision decision = members_.run(m, kUnlimited, portion);
      if (decision.status == SearchStatus::solved || decision.status == SearchStatus::failed || decision.by != nullptr)
        return decision;
    }
  }
  return {};
}

}  // namespace dismantle::portfolio
