#include "blocking/immobility.h"

#include <algorithm>

namespace dismantle::blocking {
using Kind = ImmobilityQuestion::Kind;

Immobility::Immobility(DisassemblyState& state, StraightMotion& straight, const SearchHistory& history,
                       PathOracle& oracle, const ImmobilityParams& params)
    : state_(state),
      straight_(straight),
      history_(history),
      oracle_(oracle),
      params_(params),
      answers_(oracle, params.late_share, state.context().executor) {}

bool Immobility::limit_reached(Kind kind) const {
  const auto known = proofs_.find(kind);
  const unsigned made = known == proofs_.end() ? 0 : known->second;
  switch (kind) {
    case Kind::cage:
      return made >= params_.cage_proofs;
    case Kind::flat:
      return made >= params_.flat_proofs;
    case Kind::confined_full:
      return made >= params_.early_confinement_proofs;
    case Kind::confined_half:
      break;
  }
  return made >= params_.late_confinement_proofs;
}

/// Asks until one pair is proved inseparable, and merges it. Pairs that pass each other straight are left out.
bool Immobility::merge_first(GroupState& group, const Questions& questions) {
  Questions open;
  for (const ImmobilityQuestion& q : questions) {
    if (asked_.contains(q) || std::find(open.begin(), open.end(), q) != open.end()) continue;
    if (state_.stop() || limit_reached(q.kind)) return false;
    if (!straight_.passes_any(q.a, q.b))
      open.push_back(q);
    else
      asked_.insert(q);
  }
  for (std::size_t k = 0; k < open.size(); ++k) {
    const ImmobilityQuestion& q = open[k];
    if (state_.stop() || limit_reached(q.kind)) return false;
    ++proofs_[q.kind];
    asked_.insert(q);
    state_.show_progress(q.a);
    Questions next(open.begin() + static_cast<std::ptrdiff_t>(k) + 1, open.end());
    if (before_proof) {
      const Questions likely = before_proof(group, q);
      next.insert(next.end(), likely.begin(), likely.end());
    }
    const Certificate* proof = answers_.answer(q, next, state_.context());
    if (proof == nullptr) continue;
    state_.merge(group, {q.a, q.b}, *proof);
    return true;
  }
  return false;
}

bool Immobility::merge_proved(GroupState& group, const AttemptResult& answer) {
  const Certificate* proof = answer.certificate;
  if (proof == nullptr || !proof->full_tolerance || !proof->poses.empty() || proof->parts.size() != 2) return false;
  const SubassemblyId a = state_.subassembly_of(proof->parts[0]), b = state_.subassembly_of(proof->parts[1]);
  if (a == b || !group.contains(a) || !group.contains(b)) return false;
  state_.merge(group, proof->parts, *proof);
  return true;
}

bool Immobility::merge_caged(GroupState& group) { return merge_first(group, cage_questions(group)); }

Immobility::Questions Immobility::cage_questions(const GroupState& group) const {
  const auto costs_as_much = [&](SubassemblyId s) {
    return state_.is_single(s) && history_.last(s) != nullptr &&
           history_.spent(s) >= static_cast<double>(params_.cage_proof_steps);
  };
  const bool over = group.is_pair() ? group.pair_finished : group.searches_exhausted;
  Questions questions;
  for (std::size_t i = 0; i < group.members.size(); ++i)
    for (std::size_t k = i + 1; k < group.members.size(); ++k)
      if (over || costs_as_much(group.members[i]) || costs_as_much(group.members[k]))
        add_questions(Kind::cage, group.members[i], group.members[k], questions);
  return questions;
}

bool Immobility::merge_flat(GroupState& group, SubassemblyId id) {
  if (history_.spent(id) < static_cast<double>(params_.flat_proof_steps)) return false;
  Questions questions;
  add_flat_questions(group, id, questions);
  return merge_first(group, questions);
}

bool Immobility::merge_flat(GroupState& group) { return merge_first(group, flat_questions(group)); }

Immobility::Questions Immobility::flat_questions(const GroupState& group) const {
  Questions questions;
  for (const SubassemblyId s : group.members) add_flat_questions(group, s, questions);
  return questions;
}

void Immobility::add_flat_questions(const GroupState& group, SubassemblyId id, Questions& questions) const {
  const auto size = [&](PartId part) { return state_.assembly().parts[part].mesh->box().size().norm(); };
  if (!history_.was_searched(id)) return;
  const std::vector<PartId>& touched = group.is_pair() ? state_.parts_of(group.members[group.members[0] == id ? 1 : 0])
                                                       : state_.failure_of(state_.part_of(id))->blocked_by;
  for (const PartId part : state_.parts_of(id))
    for (const PartId other : touched) {
      const SubassemblyId s = state_.subassembly_of(other);
      if (group.contains(s) && s != id && size(other) >= size(part) - oracle_.tolerance())
        questions.push_back({Kind::flat, part, other});
    }
}

bool Immobility::is_close_to_proof(const GroupState& group) const {
  return std::any_of(group.members.begin(), group.members.end(), [&](SubassemblyId s) {
    return state_.is_single(s) && history_.reached_depth_limit(s) && state_.may_leave(group, {s}) &&
           history_.last(s)->depth + 1 == params_.proof_depth;
  });
}

bool Immobility::merge_confined_early(GroupState& group) {
  Questions questions;
  for (const SubassemblyId s : group.members) {
    if (!history_.reached_depth_limit(s) || history_.last(s)->depth < params_.proof_depth) continue;
    if (const auto blocker = only_blocker(group, s)) add_questions(Kind::confined_full, s, *blocker, questions);
  }
  return merge_first(group, questions);
}

bool Immobility::merge_confined_late(GroupState& group) {
  Questions questions;
  for (const SubassemblyId s : group.members)
    if (const auto blocker = only_blocker(group, s)) add_questions(Kind::confined_half, s, *blocker, questions);
  return merge_first(group, questions);
}

bool Immobility::merge_interlocked(GroupState& group) {
  const std::vector<PartId> parts = state_.parts_of(group.members);
  if (!group.translations_exhausted || parts.size() < 3 || parts.size() > params_.interlocked_parts || state_.stop())
    return false;
  if (!interlocked_.insert(parts).second) return false;
  state_.show_progress(parts.front());
  const Certificate* proof = oracle_.prove({parts, ProofEffort::high, params_.late_share}, state_.context());
  if (proof == nullptr) return false;
  state_.merge(group, parts, *proof);
  return true;
}

void Immobility::add_questions(Kind kind, SubassemblyId a, SubassemblyId b, Questions& questions) const {
  for (const PartId p : state_.parts_of(a))
    for (const PartId q : state_.parts_of(b)) questions.push_back(ImmobilityQuestion::of_pair(kind, p, q));
}

std::optional<SubassemblyId> Immobility::only_blocker(const GroupState& group, SubassemblyId id) const {
  if (group.is_pair()) return group.members[group.members[0] == id ? 1 : 0];
  std::optional<SubassemblyId> found;
  for (const PartId part : state_.parts_of(id)) {
    const Unsolved* failure = state_.failure_of(part);
    if (failure == nullptr) continue;
    for (const PartId by : failure->blocked_by) {
      const SubassemblyId s = state_.subassembly_of(by);
      if (s == id || !group.contains(s)) continue;
      if (found && *found != s) return std::nullopt;
      found = s;
    }
  }
  return found;
}

void Immobility::begin(std::span<const ImmobilityQuestion> questions) { answers_.begin(questions, state_.context()); }

}  // namespace dismantle::blocking
