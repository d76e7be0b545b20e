#include "blocking/strategies/pair_search.h"

#include <algorithm>

namespace dismantle::blocking {
namespace {

constexpr unsigned kFirstDepth = 2;

}  // namespace

/// Waits for the rounds of other groups, which are cheaper. Several pairs take turns with limited searches.
Result PairSearch::apply(GroupState& group) {
  if (!params_.pair_searches || !group.is_pair() || group.pair_finished) return Result::unchanged;
  const auto& waiting = state_.waiting();
  if (std::any_of(waiting.begin(), waiting.end(),
                  [](const GroupState& g) { return g.members.size() > 1 && !g.searches_exhausted; }))
    return Result::defer;
  if (search(group) || group.pair_finished || state_.stop()) return Result::restart;
  return Result::defer;
}

/// A pair that a snap fit holds is searched for to the depth of few first: if that finds nothing, it is left to forced
/// steps.
unsigned PairSearch::next_depth(const GroupState& group) {
  if (group.proof != nullptr) return history_.max_depth(group);
  const unsigned depth = history_.next_depth_of_pair(group, lookahead_.other_pairs_wait());
  const unsigned of_few = snaps_.depth_of_few(group);
  return group.pair_depth < of_few && (depth == 0 || depth > of_few) ? of_few : depth;
}

/// True: the pair was separated.
bool PairSearch::search(GroupState& group) {
  const unsigned depth = next_depth(group);
  const bool last = depth == 0 || group.proof != nullptr;
  if (depth != 0) group.pair_depth = depth;
  const Subassemblies candidates = searcher_.candidates(group);
  Subassemblies open;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(open),
               [&](SubassemblyId s) { return history_.last(s) == nullptr || history_.reached_depth_limit(s); });
  // Either part may be far easier to move than the other: both come before a search without a limit.
  if (depth == 0 && group.pair_depth < kFirstDepth) {
    group.pair_depth = kFirstDepth;
    if (searcher_.search_each(group, open, kFirstDepth)) return true;
    if (state_.stop()) return false;
    std::erase_if(open, [&](SubassemblyId s) {  // proved already
      const auto* past = history_.last(s);
      return past != nullptr && past->outcome == Outcome::infeasible;
    });
  }
  if (searcher_.search_each(group, open, depth)) return true;
  if (state_.stop()) return false;
  group.waiting = history_.waiting_of(candidates);
  group.pair_finished = last || history_.waiting_of(group.members).empty();
  return false;
}

}  // namespace dismantle::blocking
