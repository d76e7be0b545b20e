#include "blocking/path_searcher.h"

#include <algorithm>
#include <string>

#include "blocking_graph/pair_proofs.h"

namespace dismantle::blocking {

PathSearcher::PathSearcher(DisassemblyState& state, SearchHistory& history, const Lookahead& lookahead,
                           PathOracle& oracle, StraightMotion* straight, SnapFits& snaps)
    : state_(state), history_(history), lookahead_(lookahead), oracle_(oracle), straight_(straight), snaps_(snaps) {}

Subassemblies PathSearcher::candidates(const GroupState& group) {
  Subassemblies single;
  for (const SubassemblyId s : group.members)
    if (state_.is_single(s) && state_.may_leave(group, {s})) single.push_back(s);
  sort_by_use(group, single);
  return single;
}

/// The use of a part is the sum of its shares in the smallest sets that block others.
void PathSearcher::sort_by_use(const GroupState& group, Subassemblies& ids) {
  if (straight_ == nullptr) return;
  std::map<SubassemblyId, double> use;
  const SubassemblyId housing = state_.housing_of(group);
  for (const SubassemblyId s : group.members) {
    const Subassemblies fewest = straight_->fewest_blockers(group, s, straight_->directions().common);
    if (state_.stop()) return;
    for (const SubassemblyId other : fewest) use[other] += 1.0 / static_cast<double>(fewest.size());
  }
  std::stable_sort(ids.begin(), ids.end(), [&](SubassemblyId a, SubassemblyId b) {
    if ((a == housing) != (b == housing)) return b == housing;
    return use[a] > use[b];
  });
}

bool PathSearcher::search_each(GroupState& group, const Subassemblies& ids, unsigned depth) {
  for (std::size_t k = 0; k < ids.size() && !state_.stop() && !is_locked(state_, group); ++k)
    if (search(group, ids[k], depth, {ids.begin() + static_cast<std::ptrdiff_t>(k) + 1, ids.end()})) return true;
  return false;
}

bool PathSearcher::search(GroupState& group, SubassemblyId id, unsigned depth, const Subassemblies& next) {
  const std::optional<MotionDepth> snap = snaps_.decided(group, id, depth);
  if (snap) depth = 1;
  const Attempt attempt = history_.attempt_for(group, id, depth);
  const PartId part = state_.part_of(id);
  RunContext& context = state_.context();
  state_.show_progress(part);
  lookahead_.before_search(group, attempt, next);
  const AttemptResult& answer = oracle_.attempt(attempt, context);
  const PathResult& result = answer.result;
  const std::uint64_t known = result.stats.resumed_nodes, spared = result.stats.spared;
  std::string line = "search for a path of '" + state_.assembly().parts[part].name + "' to depth " +
                     std::to_string(depth) + ": " + std::string(to_string(result.outcome())) + ", " +
                     std::to_string(answer.seconds) + " s";
  if (known > 0)
    line += ", from " + std::to_string(known) + " states known, " + std::to_string(spared) +
            " steps and state checks spared";
  context.log(LogLevel::debug, line);
  if (known > 0) {
    state_.count("resumed");
    state_.count("spared_steps", static_cast<double>(spared));
  }
  if (!state_.context().should_stop()) snaps_.searched(group, id, depth, is_success(result.outcome()));
  if (is_success(result.outcome())) {
    lookahead_.after_success(group, attempt);
    state_.commit(group, {id}, attempt, answer, GroupChange::Kind::removed);
    state_.count("searched");
    return true;
  }
  Outcome outcome = result.outcome();
  std::string message = result.message;
  if (snap && outcome == Outcome::depth_limit) {
    outcome = Outcome::exhausted;  // not searched deeper
    state_.count("snap_fits");
    message += (message.empty() ? "'" : "; '") + state_.assembly().parts[snap->part].name + "' and '" +
               state_.assembly().parts[snap->other].name + "' snap: a straight motion cuts in by little (" +
               "sequence_planner.snap_share), so no longer path was searched for";
  }
  if (!state_.stop() || state_.failure_of(part) == nullptr)
    state_.set_failure({part, outcome, result.blocked_by, result.best_pose, message, answer.certificate});
  history_.add(id, {depth, outcome, result.blocked_by, group.members.size()}, result);
  return false;
}

}  // namespace dismantle::blocking
