#include "blocking_graph/report.h"

#include <algorithm>

#include "blocking_graph/pair_proofs.h"

namespace dismantle::blocking {

void Report::add_left(const GroupState& group, const std::string& notes) {
  const std::vector<PartId> parts = state_.parts_of(group.members);
  if (group.initial || group.members.size() > 1) remaining_.insert(remaining_.end(), parts.begin(), parts.end());
  if (group.members.size() <= 1 || state_.target_removed()) return;
  for (const PartId part : parts) {
    if (state_.is_inseparable(state_.subassembly_of(part))) continue;  // add_inseparable() reports it
    Unsolved reason = reason_for(group, part, !notes.empty());
    if (reason.certificate == nullptr) reason.certificate = group.proof;
    if (!notes.empty()) reason.message += (reason.message.empty() ? "" : "; ") + notes;
    unsolved_.push_back(std::move(reason));
  }
}

Unsolved Report::reason_for(const GroupState& group, PartId part, bool tried) const {
  const Unsolved* failure = state_.failure_of(part);
  // The proof may have been found by a search for the other part.
  if (const Certificate* proof = pair_proof(state_, group, part);
      proof != nullptr && (failure == nullptr || failure->outcome != Outcome::infeasible)) {
    const PartId other = proof->parts.front() == part ? proof->parts.back() : proof->parts.front();
    return {part, Outcome::infeasible, {other}, {}, proof->text, proof};
  }
  if (failure != nullptr) {
    Unsolved reason = *failure;
    std::erase_if(reason.blocked_by, [&](PartId b) { return !group.contains(state_.subassembly_of(b)); });
    return reason;
  }
  Unsolved reason;
  reason.part = part;
  if (state_.interrupted()) {
    reason.outcome = state_.context().cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
    reason.message = tried ? "the whole run was stopped before a path of it alone was searched for"
                           : "not tried: stopped before its turn";
  } else {
    reason.message = state_.may_leave(group, {state_.subassembly_of(part)}) ? "no straight path, and no search was made"
                                                                            : "the constraints hold it back";
  }
  return reason;
}

void Report::add_inseparable() {
  for (SubassemblyId s = 0; s < state_.subassemblies(); ++s) {
    if (!state_.is_inseparable(s)) continue;
    for (const PartId part : state_.parts_of(s)) {
      unsolved_.push_back(proof_for(s, part));
      if (std::find(remaining_.begin(), remaining_.end(), part) == remaining_.end()) remaining_.push_back(part);
    }
  }
}

/// The oracle repeats the proof without a search.
Unsolved Report::proof_for(SubassemblyId id, PartId part) const {
  Unsolved reason;
  reason.part = part;
  if (!state_.is_inseparable(part)) {
    reason.message = "kept together with one that is locked";
    return reason;
  }
  Attempt attempt;
  for (const PartId other : state_.parts_of(id))
    (other == part ? attempt.moving : attempt.fixed).push_back({other, state_.pose(other)});
  const AttemptResult& answer = oracle_.attempt(attempt, state_.context());
  const PathResult& result = answer.result;
  reason.outcome = is_success(result.outcome()) ? Outcome::exhausted : result.outcome();
  reason.blocked_by = result.blocked_by;
  reason.message = result.message;
  reason.certificate = answer.certificate;
  return reason;
}

Outcome Report::outcome() const {
  if (unsolved_.empty()) return Outcome::solved;
  const auto is = [](Outcome o) { return [o](const Unsolved& u) { return u.outcome == o; }; };
  const auto any = [&](Outcome o) { return std::any_of(unsolved_.begin(), unsolved_.end(), is(o)); };
  const auto all = [&](Outcome o) { return std::all_of(unsolved_.begin(), unsolved_.end(), is(o)); };
  if (any(Outcome::crashed)) return Outcome::crashed;
  if (state_.interrupted()) return state_.context().cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
  for (const Outcome o : {Outcome::unsupported, Outcome::invalid_start, Outcome::infeasible})
    if (all(o)) return o;
  for (const Outcome o : {Outcome::timeout, Outcome::depth_limit})
    if (any(o)) return o;
  return Outcome::exhausted;
}

SequenceResult Report::finish() const {
  SequenceResult result;
  result.outcome = outcome();
  result.removals = state_.removals();
  result.remaining = remaining_;
  result.unsolved = unsolved_;
  result.counts = state_.counts();
  return result;
}

}  // namespace dismantle::blocking
