#include "blocking_graph/strategies/search_rounds.h"

#include <algorithm>
#include <span>

namespace dismantle::blocking {

Attempt SearchRounds::question(const GroupState& group, SubassemblyId id, unsigned depth) const {
  Attempt attempt = state_.attempt_for(group, {id});
  attempt.max_depth = depth;
  attempt.resume = settings_.resume;
  return attempt;
}

/// True: the subassembly was removed.
bool SearchRounds::search(GroupState& group, SubassemblyId id, unsigned depth, std::span<const SubassemblyId> next) {
  RunContext& context = state_.context();
  const PartId part = state_.part_of(id);
  state_.show_progress(part);
  const Attempt attempt = question(group, id, depth);
  // The answer of a search that resumes another one depends on the order of questions, so it is never speculative.
  if (context.threads > 1 && !settings_.resume) {
    std::vector<Attempt> ahead{attempt};
    // Two searches per thread keep all threads busy while one search takes long.
    for (const SubassemblyId other : next.first(std::min<std::size_t>(next.size(), 2 * context.threads)))
      ahead.push_back(question(group, other, depth));
    oracle_.prefetch(ahead, context);
  }
  const AttemptResult& answer = oracle_.attempt(attempt, context);
  const PathResult& result = answer.result;
  if (is_success(result.outcome())) {
    state_.commit(group, {id}, attempt, answer, GroupChange::Kind::removed);
    state_.count("searched");
    return true;
  }
  if (result.stats.resumed_nodes > 0) state_.count("resumed");
  if (!state_.stop() || state_.failure_of(part) == nullptr)
    state_.set_failure(
        {part, result.outcome(), result.blocked_by, result.best_pose, result.message, answer.certificate});
  rounds_[group].last[part] = result.outcome();
  return false;
}

Result SearchRounds::apply(GroupState& group) {
  Subassemblies ids;
  for (const SubassemblyId s : group.members)
    if (state_.is_single(s) && state_.may_leave(group, {s})) ids.push_back(s);
  if (order_) ids = order_(group, ids);
  ids = state_.preferred(group, ids);
  // No other part could be tried instead of the last pair, so its searches have no depth limit.
  const bool last_pair = group.is_pair() && settings_.max_depth == 0;
  Round& round = rounds_[group];
  const unsigned depth = last_pair ? 0 : round.depth;
  std::erase_if(ids, [&](SubassemblyId s) {
    const auto known = round.last.find(state_.part_of(s));
    return known != round.last.end() && known->second != Outcome::depth_limit;  // a deeper search finds nothing new
  });
  for (std::size_t k = 0; k < ids.size() && !state_.stop(); ++k)
    if (search(group, ids[k], depth, std::span(ids).subspan(k + 1))) return Result::restart;
  const bool deeper_may_help =
      std::any_of(round.last.begin(), round.last.end(), [](const auto& r) { return r.second == Outcome::depth_limit; });
  if (state_.stop() || depth == 0 || !deeper_may_help || depth == settings_.max_depth) return Result::unchanged;
  ++round.depth;
  return Result::restart;
}

void SearchRounds::on_group_changed(GroupState& group, const GroupChange&) { rounds_[group].last.clear(); }

}  // namespace dismantle::blocking
