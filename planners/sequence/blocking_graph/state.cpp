#include "blocking_graph/state.h"

#include <algorithm>

namespace dismantle::blocking {
namespace {

const auto none = std::numeric_limits<SubassemblyId>::max();

bool holds(const Subassemblies& ids, SubassemblyId id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); }

}  // namespace

bool GroupState::contains(SubassemblyId member) const { return holds(members, member); }

DisassemblyState::DisassemblyState(const SequenceQuery& query, const InseparablePairs& inseparable, PartOrder order,
                                   SequenceObserver& observer, RunContext& context)
    : assembly_(query.assembly),
      up_(query.objective.up),
      constraints_(query.constraints),
      observer_(observer),
      context_(context),
      preference_(query),
      of_part_(assembly_.parts.size(), none),
      inseparable_(assembly_.parts.size()),
      poses_(assembly_.parts.size()),
      orientation_(assembly_.parts.size(), 0) {
  std::vector<std::size_t> group_of(assembly_.parts.size(), none);
  for (std::size_t g = 0; g < query.start.size(); ++g)
    for (const PlacedPart& p : query.start[g]) {
      group_of[p.part] = g;
      set_pose(p.part, p.pose);
    }
  // Parts that a constraint keeps together anyway need no proof in the report.
  std::vector<PartId> merged = kept_sets(assembly_.parts.size(), constraints_);
  for (const auto& [a, b] : inseparable) {
    if (merged[a] != merged[b]) inseparable_[a] = inseparable_[b] = true;
    const PartId from = merged[a], to = merged[b];
    std::replace(merged.begin(), merged.end(), from, to);
  }
  // A subassembly is tried when the last of its parts in this order would be.
  const std::vector<PartId> by_order = ordered_parts(assembly_, order);
  std::map<std::pair<PartId, std::size_t>, SubassemblyId> of_root;  // by representative and group
  for (auto id = by_order.rbegin(); id != by_order.rend(); ++id) {
    if (group_of[*id] == none) continue;
    const auto [subassembly, is_new] = of_root.try_emplace({merged[*id], group_of[*id]}, parts_.size());
    if (is_new) parts_.emplace_back();
    parts_[subassembly->second].push_back(*id);
  }
  std::reverse(parts_.begin(), parts_.end());
  // Inseparable subassemblies come last, so that the others are removed from them.
  std::stable_partition(parts_.begin(), parts_.end(), [&](const auto& parts) {
    return std::none_of(parts.begin(), parts.end(), [&](PartId id) { return inseparable_[id]; });
  });
  waiting_.resize(query.start.size());
  for (SubassemblyId s = 0; s < parts_.size(); ++s) {
    waiting_[group_of[parts_[s].front()]].members.push_back(s);
    for (const PartId id : parts_[s]) of_part_[id] = s;
    std::sort(parts_[s].begin(), parts_[s].end());
    parts_left_ += parts_[s].size();
  }
  for (GroupState& group : waiting_) {
    group.initial = groups_ == 0;
    group.id = groups_++;
    most_separations_ += group.members.size() - 1;
  }
}

std::vector<PartId> DisassemblyState::parts_of(const Subassemblies& ids) const {
  std::vector<PartId> parts;
  for (const SubassemblyId s : ids) parts.insert(parts.end(), parts_[s].begin(), parts_[s].end());
  std::sort(parts.begin(), parts.end());
  return parts;
}

bool DisassemblyState::is_inseparable(SubassemblyId id) const {
  return std::any_of(parts_[id].begin(), parts_[id].end(), [&](PartId part) { return inseparable_[part]; });
}

SubassemblyId DisassemblyState::housing_of(const GroupState& group) const {
  double largest = 0;
  SubassemblyId housing = group.members.front();
  for (const SubassemblyId s : group.members) {
    Aabb box;
    for (const PartId id : parts_[s]) box.extend(assembly_.parts[id].mesh->box());
    if (box.empty() || box.size().prod() <= largest) continue;
    largest = box.size().prod();
    housing = s;
  }
  return housing;
}

void DisassemblyState::set_pose(PartId part, const Pose& pose) {
  poses_[part] = pose;
  orientation_[part] = orientations_.number_of(pose.q);
  ++arrangement_;
}

bool DisassemblyState::may_leave(const GroupState& group, const Subassemblies& ids) const {
  const auto leaves = [&](PartId id) { return holds(ids, of_part_[id]); };
  const auto stays = [&](PartId id) { return !leaves(id) && group.contains(of_part_[id]); };
  if (std::any_of(constraints_.base.begin(), constraints_.base.end(), leaves)) return false;
  return std::none_of(constraints_.before.begin(), constraints_.before.end(),
                      [&](const auto& pair) { return leaves(pair.second) && stays(pair.first); });
}

Subassemblies DisassemblyState::others(const GroupState& group, const Subassemblies& ids) const {
  Subassemblies rest;
  for (const SubassemblyId s : group.members)
    if (!holds(ids, s)) rest.push_back(s);
  return rest;
}

Attempt DisassemblyState::attempt_for(const GroupState& group, const Subassemblies& ids) const {
  Attempt attempt;
  for (const PartId id : parts_of(ids)) attempt.moving.push_back({id, poses_[id]});
  // Marked and counted, not sorted: this is asked for each step.
  std::vector<char> rest(poses_.size(), 0);
  std::size_t size = 0;
  for (const SubassemblyId s : group.members)
    for (const PartId id : parts_[s]) {
      rest[id] = 1;
      ++size;
    }
  for (const SubassemblyId s : ids)
    for (const PartId id : parts_[s]) rest[id] = 0;
  attempt.fixed.reserve(size);
  for (PartId id = 0; id < rest.size(); ++id)
    if (rest[id] != 0) attempt.fixed.push_back({id, poses_[id]});
  return attempt;
}

CandidateRemoval DisassemblyState::candidate(const GroupState& group, const Subassemblies& ids,
                                             const Eigen::Vector3d& direction) const {
  Attempt attempt = attempt_for(group, ids);
  return {std::move(attempt.moving), std::move(attempt.fixed), direction};
}

Subassemblies DisassemblyState::preferred(const GroupState& group, const Subassemblies& ids) const {
  if (!preference_.active()) return ids;
  std::vector<CandidateRemoval> candidates;
  for (const SubassemblyId id : ids) candidates.push_back(candidate(group, {id}, Eigen::Vector3d::Zero()));
  Subassemblies out;
  for (const std::size_t k : preference_.sorted(candidates, context_)) out.push_back(ids[k]);
  return out;
}

void DisassemblyState::commit(GroupState& group, const Subassemblies& ids, const Attempt& attempt,
                              const AttemptResult& answer, GroupChange::Kind kind) {
  Removal removal;
  for (std::size_t i = 0; i < attempt.moving.size(); ++i) {
    removal.parts.push_back(attempt.moving[i].part);
    set_pose(attempt.moving[i].part, answer.path().back()[i]);
  }
  removal.attempt = &answer;
  removals_.push_back(removal);
  if (preference_.active())
    preference_.removed({attempt.moving, attempt.fixed, Eigen::Vector3d::Zero()}, answer.path(), context_);
  for (GroupListener* listener : listeners_) listener->on_group_changed(group, {kind, ids});
  if (attempt.goal.placement) {
    observer_.removed(removals_.back(), parts_left_ - separations_);
    return;
  }
  const Subassemblies out = answer.out ? Subassemblies{of_part_[*answer.out]} : ids;
  group.members = others(group, out);
  ++separations_;
  if (out.size() > 1) {
    GroupState own;
    own.id = groups_++;
    own.members = out;
    std::sort(own.members.begin(), own.members.end());
    waiting_.push_back(std::move(own));
  }
  if (constraints_.target) {
    const SubassemblyId target = of_part_[*constraints_.target];
    target_removed_ = target_removed_ ||
                      (out.size() == 1 ? target == out[0] : group.members.size() == 1 && group.members[0] == target);
  }
  observer_.removed(removals_.back(), parts_left_ - separations_);
  show_progress(removal.parts.front());
}

bool DisassemblyState::stop() {
  interrupted_ = interrupted_ || context_.should_stop();
  return interrupted_ || target_removed_;
}

void DisassemblyState::show_progress(PartId part) const {
  context_.progress("sequence", separations_, most_separations_, assembly_.parts[part].name);
}

const Unsolved* DisassemblyState::failure_of(PartId part) const {
  const auto known = failures_.find(part);
  return known == failures_.end() ? nullptr : &known->second;
}

}  // namespace dismantle::blocking
