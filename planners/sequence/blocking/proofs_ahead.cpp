#include "blocking/proofs_ahead.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace dismantle::blocking {
namespace {

using Kind = HoldQuestion::Kind;

/// Of what ways may cut in.
constexpr double kShareForSure = 1, kShareAtLast = 0.5;
constexpr std::size_t kAtATime = 4;

}  // namespace

const Certificate* ProofsAhead::ask(const HoldQuestion& q, const RunContext& context) const {
  switch (q.kind) {
    case Kind::cage:
      return oracle_.prove({{q.a, q.b}, ProofEffort::low, 1}, context);
    case Kind::flat:
      return oracle_.prove({{q.a, q.b}, ProofEffort::medium, 1}, context);
    case Kind::confined_for_sure:
      return oracle_.prove({{q.a, q.b}, ProofEffort::high, kShareForSure}, context);
    case Kind::confined_at_last:
      break;
  }
  return oracle_.prove({{q.a, q.b}, ProofEffort::high, kShareAtLast}, context);
}

void ProofsAhead::begin(std::span<const HoldQuestion> wanted, const RunContext& context) {
  std::deque<Known::Sequence> first;
  for (const HoldQuestion& question : wanted) {
    if (first.size() >= kAtATime) break;
    if (known_.is_computed(question)) continue;
    first.push_back({{question, [this, question](const RunContext& c) { return ask(question, c); }}});
  }
  known_.prefetch(std::move(first), context);
}

const Certificate* ProofsAhead::answer(const HoldQuestion& question, std::span<const HoldQuestion> next,
                                       const RunContext& context) {
  std::vector<HoldQuestion> wanted;
  if (known_.is_running(question)) wanted.push_back(question);  // it goes on
  wanted.insert(wanted.end(), next.begin(), next.end());
  begin(wanted, context);
  return known_.get(
      question, [this, &question](const RunContext& c) { return ask(question, c); }, context);
}

}  // namespace dismantle::blocking
