#include "blocking_graph/strategy_list.h"

#include <string>
#include <utility>

#include "blocking_graph/pair_proofs.h"

namespace dismantle::blocking {

InseparablePairs overlap_locks(const SequenceQuery& query, PathOracle& oracle, const RunContext& context) {
  InseparablePairs pairs;
  std::vector<std::size_t> group(query.assembly.parts.size(), query.start.size());
  for (std::size_t g = 0; g < query.start.size(); ++g)
    for (const PlacedPart& p : query.start[g]) group[p.part] = g;
  for (const InitialOverlap& overlap : query.assembly.overlaps) {
    if (group[overlap.a] != group[overlap.b] || group[overlap.a] == query.start.size()) continue;
    if (const Certificate* lock = oracle.prove({{overlap.a, overlap.b}, ProofEffort::trivial, 1}, context))
      pairs.emplace_back(lock->parts[0], lock->parts[1]);
  }
  return pairs;
}

void StrategyList::add(std::unique_ptr<Strategy> strategy) {
  state_.add_listener(*strategy);
  strategies_.push_back(std::move(strategy));
}

SequenceResult StrategyList::run() {
  while (!state_.waiting().empty()) {
    GroupState group = std::move(state_.waiting().front());
    state_.waiting().pop_front();
    take_apart(std::move(group));
  }
  if (!state_.target_removed()) report_.add_inseparable();
  return report_.finish();
}

void StrategyList::take_apart(GroupState group) {
  for (std::size_t k = 0; k < strategies_.size() && group.members.size() > 1 && !state_.stop();) {
    if (is_locked(state_, group)) break;
    switch (strategies_[k]->apply(group)) {
      case Result::unchanged:
        ++k;
        break;
      case Result::restart:
        k = 0;
        break;
      case Result::defer:
        state_.waiting().push_back(std::move(group));
        return;
    }
  }
  std::string notes;
  for (const auto& strategy : strategies_)
    if (const std::string note = strategy->failure_note(group); !note.empty())
      notes += (notes.empty() ? "" : "; ") + note;
  report_.add_left(group, notes);
}

}  // namespace dismantle::blocking
