// Parts that hold each other without overlap: proved, they are moved as one.
#include <algorithm>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

/// Of a run.
std::size_t most_proofs(HoldQuestion::Kind kind) {
  switch (kind) {
    case HoldQuestion::Kind::cage:
      return 120;  // up to a second or two each
    case HoldQuestion::Kind::flat:
      return 30;  // up to ten seconds each
    case HoldQuestion::Kind::confined_for_sure:
      return 6;  // up to half a minute each
    case HoldQuestion::Kind::confined_at_last:
      break;
  }
  return 8;  // likewise
}

constexpr unsigned kDepthForSure = 4;    // of a search that was in vain
constexpr double kShareInterlocked = 0.5;  // of what paths may cut in
constexpr std::size_t kInterlocked = 8;  // parts: the effort grows with the cube of their number

}  // namespace

/// Does `a` pass `b` along any of their directions? Then no proof is to be had.
bool TakingApart::passes_straight(PartId a, PartId b) {
  std::vector<std::size_t> list = directions_.of_part[a];
  list.insert(list.end(), directions_.of_part[b].begin(), directions_.of_part[b].end());
  return std::any_of(list.begin(), list.end(), [&](std::size_t d) {
    return !relations_->blocks({a, b, d, poses_[a].t - poses_[b].t, turn_[a], turn_[b]});
  });
}

/// Asks about pairs, each once in a run, until one is proved to hold each other; makes one unit of the two.
bool TakingApart::join_first(Group& group, const std::vector<HoldQuestion>& questions) {
  std::vector<HoldQuestion> open;
  for (const HoldQuestion& q : questions) {
    if (asked_.contains(q) || std::find(open.begin(), open.end(), q) != open.end()) continue;
    if (stop() || proofs_[q.kind] == most_proofs(q.kind)) return false;
    if (!passes_straight(q.a, q.b))
      open.push_back(q);
    else
      asked_.insert(q);
  }
  for (std::size_t k = 0; k < open.size(); ++k) {
    const HoldQuestion& q = open[k];
    if (stop() || proofs_[q.kind] == most_proofs(q.kind)) return false;
    ++proofs_[q.kind];
    asked_.insert(q);
    context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[q.a].name);
    const Certificate* proof = proved(group, q, std::span(open).subspan(k + 1));
    if (proof == nullptr) continue;
    join_parts(group, {q.a, q.b}, *proof);
    return true;
  }
  return false;
}

bool TakingApart::join_held(Group& group) { return join_first(group, cage_questions(group)); }

/// About all pairs.
std::vector<HoldQuestion> TakingApart::cage_questions(const Group& group) const {
  std::vector<HoldQuestion> questions;
  for (std::size_t i = 0; i < group.units.size(); ++i)
    for (std::size_t k = i + 1; k < group.units.size(); ++k)
      add_questions(HoldQuestion::Kind::cage, group.units[i], group.units[k], questions);
  return questions;
}

/// With a proof that is dear where it succeeds. So are searches, and the deeper the dearer: it comes before the second
/// of a part, for that and the larger ones that the first touched.
bool TakingApart::join_flat(Group& group, UnitId unit) {
  if (!relations_ || !params_.cages) return false;
  std::vector<HoldQuestion> questions;
  add_flat_questions(group, unit, questions);
  return join_first(group, questions);
}

/// Likewise for all that were searched, of those that were joined in the meantime, too.
bool TakingApart::join_flat(Group& group) { return join_first(group, flat_questions(group)); }

std::vector<HoldQuestion> TakingApart::flat_questions(const Group& group) const {
  std::vector<HoldQuestion> questions;
  for (const UnitId u : group.units) add_flat_questions(group, u, questions);
  return questions;
}

void TakingApart::add_flat_questions(const Group& group, UnitId unit, std::vector<HoldQuestion>& questions) const {
  const auto size = [&](PartId id) { return assembly_.parts[id].mesh->box().size().norm(); };
  if (!cost_.contains(units_[unit].front())) return;  // never searched
  const bool pair = group.units.size() == 2;
  const std::vector<PartId>& touched =
      pair ? units_[group.units[group.units[0] == unit ? 1 : 0]] : said_.at(units_[unit].front()).blocked_by;
  for (const PartId id : units_[unit])
    for (const PartId other : touched)
      if (in_group(group, unit_of_[other]) && unit_of_[other] != unit && size(other) > size(id))
        questions.push_back({HoldQuestion::Kind::flat, id, other});
}

/// Is it one more search until join_confined_for_sure()? Of what was joined, or may not leave, none will be made.
bool TakingApart::close_to_proof(const Group& group) const {
  return relations_ && params_.cages && std::any_of(group.units.begin(), group.units.end(), [&](UnitId u) {
           return units_[u].size() == 1 && wants_depth(u) && may_leave(group, {u}) &&
                  tried_.at(units_[u].front()).depth + 1 == kDepthForSure;
         });
}

/// Before searches of a part that has only one other in its way get very long.
bool TakingApart::join_confined_for_sure(Group& group) {
  std::vector<HoldQuestion> questions;
  for (const UnitId u : group.units) {
    if (!wants_depth(u) || tried_.at(units_[u].front()).depth < kDepthForSure) continue;
    if (const std::optional<UnitId> v = alone_in_the_way(group, u))
      add_questions(HoldQuestion::Kind::confined_for_sure, u, *v, questions);
  }
  return join_first(group, questions);
}

/// After all searches, and where no part can slide for good: do all of them hold each other in place? As with
/// join_confined(), the proof is for motions that cut in less than ways may.
bool TakingApart::join_interlocked(Group& group) {
  std::vector<PartId> parts = parts_of(group.units);
  if (!group.no_slides || parts.size() < 3 || parts.size() > kInterlocked || stop()) return false;
  std::sort(parts.begin(), parts.end());
  if (!interlocked_.insert(parts).second) return false;
  context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[parts.front()].name);
  const Certificate* interlock = oracle_.prove({parts, ProofEffort::high, kShareInterlocked}, context_);
  if (interlock == nullptr) return false;
  join_parts(group, parts, *interlock);
  return true;
}

/// After all searches: the only one that is known to be in a part's way, does it hold it? That proof is for motions
/// that cut in less than ways may, so it comes last.
bool TakingApart::join_confined(Group& group) {
  std::vector<HoldQuestion> questions;
  for (const UnitId u : group.units)
    if (const std::optional<UnitId> v = alone_in_the_way(group, u))
      add_questions(HoldQuestion::Kind::confined_at_last, u, *v, questions);
  return join_first(group, questions);
}

void TakingApart::add_questions(HoldQuestion::Kind kind, UnitId u, UnitId v,
                                std::vector<HoldQuestion>& questions) const {
  for (const PartId a : units_[u])
    for (const PartId b : units_[v]) questions.push_back(HoldQuestion::of_pair(kind, a, b));
}

/// The unit that all parts belong to which the last search for a way of `unit` touched; of two, the other.
auto TakingApart::alone_in_the_way(const Group& group, UnitId unit) const -> std::optional<UnitId> {
  if (group.units.size() == 2) return group.units[group.units[0] == unit ? 1 : 0];
  std::optional<UnitId> found;
  for (const PartId id : units_[unit]) {
    const auto said = said_.find(id);
    if (said == said_.end()) continue;
    for (const PartId by : said->second.blocked_by) {
      const UnitId v = unit_of_[by];
      if (v == unit || !in_group(group, v)) continue;
      if (found && *found != v) return std::nullopt;
      found = v;
    }
  }
  return found;
}

void TakingApart::join_parts(Group& group, const std::vector<PartId>& parts, const Certificate& proof) {
  context_.log(LogLevel::info, proof.text);
  for (const PartId part : parts) {
    std::vector<PartId> others = parts;
    std::erase(others, part);
    locked_[part] = true;
    const Outcome outcome = proof.full_tolerance ? Outcome::infeasible : Outcome::exhausted;
    held_.try_emplace(part, Unsolved{part, outcome, others, {}, proof.text, &proof});
  }
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (unit_of_[parts[i]] != unit_of_[parts[0]]) join(group, unit_of_[parts[0]], unit_of_[parts[i]]);
}

/// Makes one unit of two, under the number of the first.
void TakingApart::join(Group& group, UnitId u, UnitId v) {
  for (const PartId id : units_[v]) unit_of_[id] = u;
  units_[u].insert(units_[u].end(), units_[v].begin(), units_[v].end());
  std::sort(units_[u].begin(), units_[u].end());
  units_[v].clear();
  std::erase(group.units, v);
  // What was known of either says too little of both.
  watched_[u].clear();
  watched_[v].clear();
  refused_.clear();
  group.groups_done = group.slides_done = group.turns_done = group.searched_out = group.pair_done =
      group.searches_done = false;
  ++counts_["held"];
}

}  // namespace dismantle::blocking
