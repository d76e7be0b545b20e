#include "blocking/proofs_ahead.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace dismantle::blocking {
namespace {

using Kind = ImmobilityQuestion::Kind;

}  // namespace

/// Cheap proofs are tried first.
const Certificate* ProofsAhead::ask(const ImmobilityQuestion& q, const RunContext& context) const {
  const std::vector<PartId> pair{q.a, q.b};
  if (const Certificate* found = oracle_.prove({pair, ProofEffort::low, 1}, context)) return found;
  if (q.kind == Kind::cage) return nullptr;
  if (const Certificate* found = oracle_.prove({pair, ProofEffort::medium, 1}, context)) return found;
  if (q.kind == Kind::flat) return nullptr;
  return oracle_.prove({pair, ProofEffort::high, q.kind == Kind::confined_full ? 1 : late_share_}, context);
}

void ProofsAhead::begin(std::span<const ImmobilityQuestion> wanted, const RunContext& context) {
  std::deque<Known::Sequence> first;
  for (const ImmobilityQuestion& question : wanted) {
    if (first.size() >= context.threads) break;
    if (known_.is_computed(question)) continue;
    first.push_back({{question, [this, question](const RunContext& c) { return ask(question, c); }}});
  }
  known_.prefetch(std::move(first), context);
}

const Certificate* ProofsAhead::answer(const ImmobilityQuestion& question, std::span<const ImmobilityQuestion> next,
                                       const RunContext& context) {
  std::vector<ImmobilityQuestion> wanted;
  if (known_.is_running(question)) wanted.push_back(question);  // it goes on
  wanted.insert(wanted.end(), next.begin(), next.end());
  begin(wanted, context);
  return known_.get(
      question, [this, &question](const RunContext& c) { return ask(question, c); }, context);
}

}  // namespace dismantle::blocking
